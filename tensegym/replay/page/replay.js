// The page: its controls, its clock, and the loop that plays.
const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const get = (id) => document.getElementById(id);

async function start() {
  const recording = await unpack(get("recording").textContent);
  const robot = new Robot(recording), view = new View(get("view"), recording, robot);
  const lean = Math.acos(Math.min(1, view.up[2])) * 180 / Math.PI;
  document.title = get("title").textContent = recording.title || "tensegym replay";
  get("about").textContent = [`robot ${recording.scenery.name}`, `${recording.engine}, time step ${1e3 * recording.dt} ms`,
    ...(lean > 0.05 ? [`slope ${lean.toFixed(1)}\u00b0`] : [])].join(" \u00b7 ");
  drawKey(recording.scenery);

  let playing = false, seen = 0;
  const slider = get("time");
  Object.assign(slider, { min: robot.first, max: robot.last, value: robot.first });
  const plots = makePlots(get("plots"), recording, robot, (time) => seek(time));

  function draw() {
    view.draw();
    plots.forEach((plot) => plot.draw());
    const face = recording.scenery.faces[recording.arrays.faces[robot.row]];
    const name = face ? `\nface ${[...face].map((n) => n + 1).sort((a, b) => a - b).join("-")}` : "";
    get("clock").textContent = `t = ${robot.time.toFixed(2)} s${name}`;
    slider.value = robot.time;
  }
  function seek(time) {
    robot.seek(Math.min(robot.last, Math.max(robot.first, time)));
    draw();
  }
  function play(on) {
    if (on && robot.time >= robot.last) robot.seek(robot.first);
    playing = on;
    get("play").textContent = on ? "Pause" : "Play";
    seen = performance.now();
    if (on) requestAnimationFrame(tick);
  }
  function tick(now) {
    if (!playing) return;
    seek(robot.time + Math.max(0, now - seen) / 1e3 * Number(get("speed").value));
    seen = now;
    if (robot.time >= robot.last) play(false); else requestAnimationFrame(tick);
  }
  function step(by) {
    play(false);
    const at = robot.row + (by < 0 && robot.share > 1e-9 ? 0 : by) + (by > 0 && robot.share > 1 - 1e-9 ? 1 : 0);
    seek(robot.times[Math.min(robot.times.length - 1, Math.max(0, at))]);
  }

  SPEEDS.forEach((s) => get("speed").append(new Option(`${s}\u00d7`, s, s === 1, s === 1)));
  slider.addEventListener("input", () => { play(false); seek(Number(slider.value)); });
  get("play").addEventListener("click", () => play(!playing));
  get("back").addEventListener("click", () => step(-1));
  get("on").addEventListener("click", () => step(1));
  for (const name of ["numbers", "trail", "follow"]) {
    view[name] = get(name).checked;
    get(name).addEventListener("change", (e) => { view[name] = e.target.checked; draw(); });
  }
  document.addEventListener("keydown", (e) => {
    if (["INPUT", "SELECT", "BUTTON"].includes(e.target.tagName)) return;
    const act = { " ": () => play(!playing), ArrowLeft: () => step(-1), ArrowRight: () => step(1) }[e.key];
    if (act) { e.preventDefault(); act(); }
  });
  const asked = new URLSearchParams(location.hash.slice(1)).get("t"); // run.html#t=4.3
  if (asked !== null && Number.isFinite(Number(asked))) robot.seek(Math.min(robot.last, Math.max(robot.first, Number(asked))));
  const layOut = () => { plots.forEach((plot) => plot.layOut()); draw(); };
  window.addEventListener("resize", layOut);
  layOut();
  window.replay = { recording, robot, view, seek, play }; // for the console
  document.body.dataset.ready = "yes";
}

function drawKey(scenery) {
  const pen = get("scale").getContext("2d"), { width, height } = get("scale");
  for (let x = 0; x < width; x++) {
    pen.fillStyle = tensionColour(scenery, scenery.full_scale * (x - 20) / (width - 20));
    pen.fillRect(x, x < 20 ? height / 2 - 1 : 0, 1, x < 20 ? 2 : height);
  }
  get("most").textContent = `${scenery.full_scale} N`;
}

start().catch((error) => {
  get("about").textContent = `This replay cannot be shown: ${error.message}`;
  throw error;
});
