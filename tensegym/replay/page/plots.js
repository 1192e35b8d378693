// Plots over time with the limits in them; a line marks the present, and a click or a drag goes to another time.
class Plot {
  constructor(parent, robot, { name, unit, lines, band = null, limits = [] }, seek) {
    Object.assign(this, { robot, name, unit, lines, band, limits });
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("aria-label", `${name} [${unit}] over time`);
    parent.append(this.canvas);
    this.picture = document.createElement("canvas"); // all but the line of the present
    const values = [...lines.flatMap((l) => extremes(l.values)), ...limits, ...(band ? [...extremes(band[0]), ...extremes(band[1])] : [])];
    const low = Math.min(0, ...values), high = Math.max(0, ...values), room = 0.06 * (high - low || 1);
    Object.assign(this, { low: low - (low < 0 ? room : 0), high: high + room });
    const go = (e) => {
      if (!e.buttons) return;
      const box = this.canvas.getBoundingClientRect();
      seek(robot.first + (robot.last - robot.first) * Math.min(1, Math.max(0, (e.clientX - box.left - LEFT) / (box.width - LEFT - RIGHT))));
    };
    this.canvas.addEventListener("pointerdown", (e) => { this.canvas.setPointerCapture(e.pointerId); go(e); });
    this.canvas.addEventListener("pointermove", go);
  }

  x(time) { return LEFT + (this.width - LEFT - RIGHT) * (time - this.robot.first) / (this.robot.last - this.robot.first || 1); }
  y(value) { return this.height - BELOW - (this.height - ABOVE - BELOW) * (value - this.low) / (this.high - this.low); }

  layOut() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    Object.assign(this, { width: box.width, height: box.height });
    for (const canvas of [this.canvas, this.picture]) {
      canvas.width = Math.max(1, Math.round(box.width * ratio));
      canvas.height = Math.max(1, Math.round(box.height * ratio));
    }
    const pen = this.picture.getContext("2d"), { times, first, last } = this.robot;
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.font = "12px system-ui, sans-serif";
    pen.fillStyle = "#1b1f24";
    pen.fillText(`${this.name} [${this.unit}]`, LEFT, 13);
    this.ticks(pen, first, last);
    if (this.band) {
      pen.fillStyle = "rgba(120, 130, 140, 0.25)";
      pen.beginPath();
      times.forEach((t, k) => pen.lineTo(this.x(t), this.y(this.band[1][k])));
      for (let k = times.length - 1; k >= 0; k--) pen.lineTo(this.x(times[k]), this.y(this.band[0][k]));
      pen.fill();
    }
    for (const limit of this.limits) this.stroke(pen, [first, last], [limit, limit], "#111", [6, 4], 1);
    for (const { values, colour, dash } of this.lines) this.stroke(pen, times, values, colour, dash, dash ? 1 : 1.6);
  }

  ticks(pen, first, last) {
    pen.strokeStyle = "#e3e7eb";
    pen.fillStyle = "#555e68";
    pen.lineWidth = 1;
    for (const value of roundSteps(this.low, this.high, 4)) {
      pen.strokeRect(LEFT, this.y(value), this.width - LEFT - RIGHT, 0);
      pen.textAlign = "right";
      pen.fillText(String(value), LEFT - 5, this.y(value) + 4);
    }
    pen.textAlign = "center";
    for (const time of roundSteps(first, last, 6)) {
      pen.strokeRect(this.x(time), ABOVE, 0, this.height - ABOVE - BELOW);
      pen.fillText(`${time} s`, this.x(time), this.height - 4);
    }
    pen.textAlign = "left";
  }

  stroke(pen, times, values, colour, dash, width) {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.setLineDash(dash || []);
    pen.beginPath();
    for (let k = 0; k < times.length; k++) pen.lineTo(this.x(times[k]), this.y(values[k]));
    pen.stroke();
    pen.setLineDash([]);
  }

  draw() {
    const ratio = window.devicePixelRatio || 1, pen = this.canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.drawImage(this.picture, 0, 0);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.fillStyle = "#d55e00";
    pen.fillRect(this.x(this.robot.time) - 0.75, ABOVE, 1.5, this.height - ABOVE - BELOW);
  }
}

const LEFT = 52, RIGHT = 12, ABOVE = 20, BELOW = 20;

function extremes(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) { if (v < low) low = v; if (v > high) high = v; }
  return [low, high];
}

function roundSteps(low, high, count) { // about so many round numbers
  const rough = (high - low) / count || 1, power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= rough), found = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9; k++) found.push(Number((k * step).toPrecision(6)));
  return found;
}

function speeds(robot) { // along the ground, over a tenth of a second to either side
  const { times } = robot, places = Array.from(times, (_, row) => robot.centreAt(row));
  let a = 0, b = 0;
  return Float64Array.from(times, (t) => {
    while (times[a] < t - 0.1) a++;
    while (b < times.length - 1 && times[b] < t + 0.1) b++;
    return times[b] > times[a] ? Math.hypot(places[b][0] - places[a][0], places[b][1] - places[a][1]) / (times[b] - times[a]) : 0;
  });
}

function makePlots(parent, recording, robot, seek) {
  const { arrays, scenery } = recording, { colours, limits } = scenery, { driven } = scenery.cables;
  const column = (name, c) => Float64Array.from(robot.times, (_, row) => arrays[name][row * arrays[name].width + c]);
  const drives = Array.from({ length: arrays.angles.width }, (_, d) => d);
  const each = (name, dash, shift = 0) => drives.map((d) => ({
    values: column(name, d + shift), colour: colours[d % colours.length], dash }));
  const pins = Array.from({ length: arrays.bends.width }, (_, p) => p);
  const rest = Array.from({ length: arrays.tensions.width }, (_, c) => c).filter((c) => c < driven[0] || c >= driven[1]);
  const band = [Math.min, Math.max].map((pick) => Float64Array.from(robot.times, (_, row) =>
    rest.reduce((m, c) => pick(m, arrays.tensions[row * arrays.tensions.width + c]), pick === Math.min ? Infinity : -Infinity)));
  const legend = document.createElement("p");
  legend.style.cssText = "margin: 6px 12px 0; display: flex; gap: 12px; flex-wrap: wrap; font-size: 12px";
  drives.forEach((d) => {
    const name = document.createElement("span");
    name.textContent = `\u25ac drive ${d + 1}`;
    name.style.color = colours[d % colours.length];
    legend.append(name);
  });
  const more = document.createElement("span");
  more.textContent = "dashed: limits; grey: elastic cables, least to most";
  legend.append(more);
  parent.append(legend);
  return [
    { name: "Cable tension", unit: "N", lines: each("tensions", undefined, driven[0]), band: rest.length ? band : null, limits: [limits.tension] },
    { name: "Drive current", unit: "A", lines: each("currents"), limits: [limits.current, -limits.current] },
    { name: "Spool angle (dashed: commanded)", unit: "rad", lines: [...each("commands", [4, 3]), ...each("angles")] },
    ...(pins.length ? [{ name: "Bend of the split rods", unit: "rad", lines: pins.map((p) => ({ values: column("bends", p), colour: colours[p % colours.length] })) }] : []),
    { name: "Speed of the centre of mass", unit: "m/s", lines: [{ values: speeds(robot), colour: "#111" }] },
  ].map((what) => new Plot(parent, robot, what, seek));
}
