// The 3-D view, on a plain canvas: everything is cut into short pieces that are painted from far to near.
const PIECES = 8; // of a rod or a cable

class View {
  constructor(canvas, recording, robot) {
    Object.assign(this, { canvas, recording, robot, pen: canvas.getContext("2d") });
    Object.assign(this, { turn: 0.9, rise: 0.42, zoom: 3.0, numbers: false, trail: true, follow: true });
    const g = recording.arrays.gravity, size = Math.hypot(...g) || 1;
    this.up = size > 1e-9 && Math.hypot(...g) > 0 ? [-g[0] / size, -g[1] / size, -g[2] / size] : [0, 0, 1];
    this.target = robot.centre();
    this.trailPoints = Array.from(robot.times, (_, row) => robot.centreAt(row));
    this.grab();
  }

  grab() {
    let from = null;
    this.canvas.addEventListener("pointerdown", (e) => {
      from = [e.clientX, e.clientY];
      this.canvas.setPointerCapture(e.pointerId);
    });
    this.canvas.addEventListener("pointermove", (e) => {
      if (!from) return;
      this.turn -= (e.clientX - from[0]) / 150;
      this.rise = Math.min(1.5, Math.max(0.03, this.rise + (e.clientY - from[1]) / 200));
      from = [e.clientX, e.clientY];
      this.draw();
    });
    this.canvas.addEventListener("pointerup", () => { from = null; });
    this.canvas.addEventListener("wheel", (e) => {
      e.preventDefault();
      this.zoom = Math.min(30, Math.max(0.8, this.zoom * Math.exp(e.deltaY / 800)));
      this.draw();
    }, { passive: false });
  }

  aim() { // the camera's axes: right, upwards in the picture, and towards it
    const up = this.up, side = normal(cross(up, Math.abs(up[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0])), ahead = cross(side, up);
    const c = Math.cos(this.turn), s = Math.sin(this.turn);
    const flat = [0, 1, 2].map((k) => c * ahead[k] + s * side[k]);
    const back = [0, 1, 2].map((k) => Math.cos(this.rise) * flat[k] + Math.sin(this.rise) * up[k]);
    const right = normal(cross(up, back));
    Object.assign(this, { right, upward: cross(back, right), back });
    const length = this.robot.scenery.length;
    this.distance = this.zoom * length;
    if (this.follow) this.target = this.robot.centre();
  }

  project(p) { // [x, y, depth] in pixels and metres; null behind the camera
    const d = [p[0] - this.target[0], p[1] - this.target[1], p[2] - this.target[2]];
    const depth = this.distance - dot(d, this.back);
    if (depth < 0.05) return null;
    const scale = this.focal / depth;
    return [this.width / 2 + scale * dot(d, this.right), this.height / 2 - scale * dot(d, this.upward), depth];
  }

  line(a, b, colour, pixels, dash = []) {
    const p = this.project(a), q = this.project(b), pen = this.pen;
    if (!p || !q) return;
    pen.strokeStyle = colour;
    pen.lineWidth = pixels;
    pen.setLineDash(dash);
    pen.beginPath();
    pen.moveTo(p[0], p[1]);
    pen.lineTo(q[0], q[1]);
    pen.stroke();
    pen.setLineDash([]);
  }

  draw() {
    const ratio = window.devicePixelRatio || 1, box = this.canvas.getBoundingClientRect();
    const pen = this.pen;
    this.canvas.width = Math.max(1, Math.round(box.width * ratio));
    this.canvas.height = Math.max(1, Math.round(box.height * ratio));
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    Object.assign(this, { width: box.width, height: box.height, focal: 1.25 * Math.min(box.width, box.height) });
    pen.lineCap = "round";
    pen.lineJoin = "round";
    this.aim();
    this.drawGround();
    const items = [];
    this.addGoal(items);
    this.addBoxes(items);
    this.addRobot(items);
    items.sort((a, b) => b.depth - a.depth).forEach((item) => item.paint());
    if (this.numbers) this.drawNumbers();
  }

  level(x, y) { // of the ground [m]
    const { heights } = this.recording.arrays, n = heights.width, cell = this.recording.ground;
    if (!n) return 0;
    const u = Math.min(n - 2, Math.max(0, x / cell + (n - 1) / 2)), v = Math.min(n - 2, Math.max(0, y / cell + (n - 1) / 2));
    const i = Math.floor(u), j = Math.floor(v), a = u - i, b = v - j, at = (k, l) => heights[k * n + l];
    return (1 - a) * ((1 - b) * at(i, j) + b * at(i, j + 1)) + a * ((1 - b) * at(i + 1, j) + b * at(i + 1, j + 1));
  }

  drawGround() {
    if (this.recording.ground === null) return;
    const rough = this.recording.arrays.heights.width > 0, length = this.robot.scenery.length;
    const spacing = rough ? 0.15 * length : 0.5 * length, reach = rough ? 2.2 * length : 6 * length;
    const middle = [0, 1].map((k) => spacing * Math.round(this.target[k] / spacing)), count = Math.round(reach / spacing);
    const step = rough ? 1 : 4; // cells a stroke
    for (let i = -count; i <= count; i++) {
      for (let j = -count; j < count; j += step) {
        const fade = 1 - Math.hypot(i, j + step / 2) / count;
        if (fade <= 0) continue;
        const colour = `rgba(90, 105, 120, ${(rough ? 0.75 : 0.5) * fade})`;
        for (const swap of [false, true]) {
          const ends = [j, Math.min(count, j + step)].map((k) => {
            const at = swap ? [k, i] : [i, k];
            const x = middle[0] + spacing * at[0], y = middle[1] + spacing * at[1];
            return [x, y, this.level(x, y)];
          });
          this.line(ends[0], ends[1], colour, 1);
        }
      }
    }
  }

  onTop(x, y) { // of the ground, or of the highest box there
    const { boxes } = this.recording.arrays;
    let z = this.level(x, y);
    for (let k = 0; k < boxes.length; k += 10) z = Math.max(z, boxTop(boxes.subarray(k, k + 10), x, y));
    return [x, y, z + 0.002];
  }

  addLine(items, from, to, colour, pixels) { // between points [x, y], laid over ground and boxes, in pieces to be sorted
    const flat = !this.recording.arrays.boxes.length, rough = this.recording.arrays.heights.width > 0;
    const length = Math.hypot(to[0] - from[0], to[1] - from[1]), piece = 0.1 * this.robot.scenery.length;
    const count = flat && !rough ? 1 : Math.min(200, Math.max(1, Math.ceil(length / piece)));
    const at = (k) => this.onTop(from[0] + (to[0] - from[0]) * k / count, from[1] + (to[1] - from[1]) * k / count);
    for (let k = 0, a = at(0); k < count; k++) {
      const p = a, q = at(k + 1), seen = this.project(p), other = this.project(q);
      const depth = flat ? Infinity : seen && other && Math.min(seen[2], other[2]); // on a patch, not in it
      if (depth) items.push({ depth, paint: () => this.line(p, q, colour, pixels) });
      a = q;
    }
  }

  addGoal(items) { // path, trail, support, direction, place, and what is below the centre of mass
    const { arrays } = this.recording, robot = this.robot, length = robot.scenery.length;
    for (let k = 0; k + 3 < arrays.path.length; k += 2)
      this.addLine(items, arrays.path.subarray(k, k + 2), arrays.path.subarray(k + 2, k + 4), "#009e73", 3);
    if (this.trail)
      for (let row = 4; row <= robot.row; row += 4)
        this.addLine(items, this.trailPoints[row - 4], this.trailPoints[row], "rgba(30, 30, 30, 0.55)", 1.5);
    const centre = robot.centre(), i = 2 * robot.row;
    const face = robot.scenery.faces[arrays.faces[robot.row]];
    if (face && this.recording.ground !== null)
      items.push({ depth: Infinity,
                   paint: () => this.polygon(face.map((n) => robot.node(n)), "rgba(0, 114, 178, 0.13)") });
    const [u, v] = [arrays.directions[i], arrays.directions[i + 1]];
    if (Number.isFinite(u)) {
      const tip = 1.15 * length, at = (along, aside) =>
        [centre[0] + along * u - aside * v, centre[1] + along * v + aside * u];
      this.addLine(items, at(0.55 * length, 0), at(tip, 0), "#0072b2", 5);
      this.addLine(items, at(tip - 0.12 * length, 0.09 * length), at(tip, 0), "#0072b2", 5);
      this.addLine(items, at(tip - 0.12 * length, -0.09 * length), at(tip, 0), "#0072b2", 5);
    }
    const [x, y] = [arrays.places[i], arrays.places[i + 1]];
    if (Number.isFinite(x)) this.addRing(items, x, y, 0.2 * length, "#d55e00", 4);
    this.addRing(items, centre[0], centre[1], 0.015 * length, "#111", 3);
  }

  addRing(items, x, y, radius, colour, pixels) {
    const at = (k) => [x + radius * Math.cos(k * Math.PI / 12), y + radius * Math.sin(k * Math.PI / 12)];
    for (let k = 0; k < 24; k++) this.addLine(items, at(k), at(k + 1), colour, pixels);
  }

  polygon(points, colour) {
    const seen = points.map((p) => this.project(p));
    if (seen.includes(null)) return;
    this.pen.fillStyle = colour;
    this.pen.beginPath();
    seen.forEach((p, k) => (k ? this.pen.lineTo(p[0], p[1]) : this.pen.moveTo(p[0], p[1])));
    this.pen.closePath();
    this.pen.fill();
    this.pen.strokeStyle = colour; // else a hairline of background is left between two patches
    this.pen.lineWidth = 0.7;
    this.pen.stroke();
  }

  addBoxes(items) {
    const { boxes } = this.recording.arrays;
    for (let k = 0; k < boxes.length; k += 10)
      this.addBox(items, [...boxes.subarray(k, k + 3), ...boxes.subarray(k + 6, k + 10)],
                  Array.from(boxes.subarray(k + 3, k + 6), (half) => 2 * half), [0.69, 0.72, 0.75, 1], true);
  }

  addBox(items, pose, sides, rgba, stands = false) { // its faces towards the camera, each shaded by how far up it looks
    const camera = this.target.map((x, k) => x + this.distance * this.back[k]);
    for (let axis = 0; axis < 3; axis++)
      for (const sign of [-1, 1]) {
        const [u, v] = [(axis + 1) % 3, (axis + 2) % 3];
        const side = 0.35 * this.robot.scenery.length, at = (a, b) => {
          const p = [0, 0, 0];
          p[axis] = sign * sides[axis] / 2; p[u] = (a - 0.5) * sides[u]; p[v] = (b - 0.5) * sides[v];
          return turned(pose, p);
        };
        const out = [0, 1, 2].map((k) => sign * (turned(pose, UNIT[axis])[k] - pose[k]));
        if (dot(out, at(0.5, 0.5).map((x, k) => camera[k] - x)) <= 0) continue;
        const light = 0.82 + 0.18 * dot(out, this.up);
        const n = Math.min(24, Math.ceil(sides[u] / side)), m = Math.min(24, Math.ceil(sides[v] / side));
        const colours = [1, Math.min(n, m) > 2 ? 0.95 : 1].map((tint) => shade(rgba, tint * light)); // shows a slope
        for (let i = 0; i < n; i++)
          for (let j = 0; j < m; j++) { // short patches, so that they are painted in the right order
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]].map(([a, b]) => at(a / n, b / m));
            if (stands && corners.every((p) => p[2] < 1e-9)) continue; // in the ground
            if (stands) corners = corners.map((p) => raised(p, out));
            const seen = corners.map((p) => this.project(p)); // by the farthest, so that it hides nothing on top of it
            if (!seen.includes(null))
              items.push({ depth: Math.max(...seen.map((p) => p[2])), paint: () => this.polygon(corners, colours[(i + j) % 2]) });
          }
      }
  }

  addRobot(items) {
    const robot = this.robot, { scenery } = robot;
    for (const solid of scenery.solids) {
      const [radius, length] = solid.size;
      if (solid.kind === "sphere") this.addBall(items, robot.point(solid.body, [0, 0, solid.z]), radius, solid.colour);
      else if (solid.kind === "box") {
        const pose = robot.pose.slice(7 * solid.body, 7 * solid.body + 7);
        pose.set(robot.point(solid.body, [0, 0, solid.z]));
        this.addBox(items, pose, solid.size, solid.colour);
      } else {
        const ends = [-0.5, 0.5].map((s) => robot.point(solid.body, [0, 0, solid.z + s * length]));
        this.addTube(items, ends[0], ends[1], radius, solid.colour);
      }
    }
    const { bodies, points, driven } = scenery.cables;
    bodies.forEach(([a, b], c) => {
      const from = robot.point(a, points[c].slice(0, 3)), to = robot.point(b, points[c].slice(3));
      const tension = robot.value("tensions", c), wound = c >= driven[0] && c < driven[1];
      const pixels = tension > 0.01 ? (wound ? 3.5 : 2) : 1;
      this.addPieces(items, from, to, (p, q) => this.line(p, q, tensionColour(scenery, tension), pixels));
    });
    const centre = robot.centre(), seen = this.project(centre);
    if (seen) items.push({ depth: 0, paint: () => this.cross(seen) });
  }

  addPieces(items, from, to, paint) {
    const at = (k) => from.map((x, i) => x + (to[i] - x) * Math.min(1, k / PIECES));
    for (let k = 0; k < PIECES; k++) { // each a little into the next, so that no seam is seen
      const seen = this.project(at(k + 0.5));
      if (seen) items.push({ depth: seen[2], paint: () => paint(at(k), at(k + 1.05)) });
    }
  }

  addTube(items, from, to, radius, rgba) {
    const wide = (p) => Math.max(3, 2 * radius * this.focal / p[2]);
    this.addPieces(items, from, to, (p, q) => {
      const seen = this.project(p);
      if (!seen) return;
      this.pen.lineCap = "butt";
      this.line(p, q, shade(rgba, 0.62), wide(seen));
      this.line(p, q, shade(rgba, 1.05), 0.55 * wide(seen));
      this.pen.lineCap = "round";
    });
    if (this.recording.ground !== null) {
      const down = (p) => [p[0], p[1], this.level(p[0], p[1])];
      items.push({ depth: Infinity, paint: () => this.line(down(from), down(to), "rgba(20, 30, 40, 0.10)", 5) });
    }
  }

  addBall(items, middle, radius, rgba) {
    const seen = this.project(middle);
    if (!seen) return;
    items.push({ depth: seen[2], paint: () => {
      const r = Math.max(3.5, radius * this.focal / seen[2]), pen = this.pen;
      const fill = pen.createRadialGradient(seen[0] - 0.35 * r, seen[1] - 0.4 * r, 0.1 * r, seen[0], seen[1], r);
      fill.addColorStop(0, shade(rgba, 1.45));
      fill.addColorStop(1, shade(rgba, 0.62));
      pen.fillStyle = fill;
      pen.beginPath();
      pen.arc(seen[0], seen[1], r, 0, 2 * Math.PI);
      pen.fill();
    } });
  }

  cross([x, y]) { // the centre of mass
    const pen = this.pen;
    pen.strokeStyle = "#111";
    pen.lineWidth = 2;
    pen.beginPath();
    pen.arc(x, y, 5, 0, 2 * Math.PI);
    pen.moveTo(x - 8, y); pen.lineTo(x + 8, y); pen.moveTo(x, y - 8); pen.lineTo(x, y + 8);
    pen.stroke();
  }

  drawNumbers() {
    const pen = this.pen;
    pen.font = "600 13px system-ui, sans-serif";
    this.robot.scenery.nodes.bodies.forEach((_, n) => {
      const seen = this.project(this.robot.node(n));
      if (!seen) return;
      pen.lineWidth = 3;
      pen.strokeStyle = "#fff";
      pen.strokeText(String(n + 1), seen[0] + 8, seen[1] - 6);
      pen.fillStyle = "#111";
      pen.fillText(String(n + 1), seen[0] + 8, seen[1] - 6);
    });
  }
}

const UNIT = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const normal = (a) => { const n = Math.hypot(...a) || 1; return a.map((x) => x / n); };

function turned(pose, p) { // a point of a frame in the world
  const v = [pose[3], pose[4], pose[5]], c = cross(v, p).map((x) => 2 * x), d = cross(v, c);
  return [0, 1, 2].map((k) => pose[k] + p[k] + pose[6] * c[k] + d[k]);
}

function raised(p, normal) { // a point of a face, moved up along it to z = 0 where it is below
  const steep = 1 - normal[2] * normal[2], up = p[2] < 0 && steep > 1e-9 ? -p[2] / steep : 0;
  return [0, 1, 2].map((k) => p[k] + up * ((k === 2) - normal[2] * normal[k]));
}

function boxTop(box, x, y) { // where a vertical line leaves a box (centre, half sides, quaternion); -Infinity beside it
  const u = x - box[0], v = y - box[1];
  if (u * u + v * v > box[3] * box[3] + box[4] * box[4] + box[5] * box[5]) return -Infinity; // soon done with most
  const back = [0, 0, 0, -box[6], -box[7], -box[8], box[9]], up = turned(back, [0, 0, 1]);
  const foot = turned(back, [u, v, -box[2]]);
  let enters = -Infinity, leaves = Infinity;
  for (let k = 0; k < 3; k++) {
    const slope = Math.abs(up[k]) < 1e-12 ? 1e-12 : up[k];
    const ends = [(-box[3 + k] - foot[k]) / slope, (box[3 + k] - foot[k]) / slope];
    enters = Math.max(enters, Math.min(...ends));
    leaves = Math.min(leaves, Math.max(...ends));
  }
  return enters <= leaves ? leaves : -Infinity;
}

function shade(rgba, light) {
  const part = (x) => Math.round(Math.min(255, 255 * x * light));
  return `rgba(${part(rgba[0])}, ${part(rgba[1])}, ${part(rgba[2])}, ${rgba[3]})`;
}

function tensionColour(scenery, tension) { // grey where slack
  if (!(tension > 0.01)) return "rgb(165, 170, 175)";
  const stops = scenery.tension_colours, at = Math.min(1, tension / scenery.full_scale) * (stops.length - 1);
  const i = Math.min(stops.length - 2, Math.floor(at)), s = at - i;
  return `rgb(${stops[i].map((x, k) => Math.round((1 - s) * x + s * stops[i + 1][k])).join(", ")})`;
}
