// The robot at any time: rows of the recording, with straight lines and turns between them.
class Robot {
  constructor(recording) {
    this.arrays = recording.arrays;
    this.times = recording.arrays.times;
    this.scenery = recording.scenery;
    this.bodies = this.scenery.masses.length;
    this.pose = new Float64Array(7 * this.bodies);
    this.first = this.times[0];
    this.last = this.times[this.times.length - 1];
    this.seek(this.first);
  }

  seek(time) {
    const { times, arrays } = this;
    let low = 0, high = times.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= time) low = middle; else high = middle;
    }
    if (times.length === 1) high = 0;
    const step = times[high] - times[low];
    const share = step > 0 ? Math.min(1, Math.max(0, (time - times[low]) / step)) : 0;
    Object.assign(this, { time, row: low, next: high, share });
    for (let b = 0; b < this.bodies; b++) {
      const i = (low * this.bodies + b) * 7, j = (high * this.bodies + b) * 7, p = arrays.poses, o = 7 * b;
      let dot = 0;
      for (let k = 3; k < 7; k++) dot += p[i + k] * p[j + k];
      const sign = dot < 0 ? -1 : 1;
      let norm = 0;
      for (let k = 0; k < 7; k++) {
        this.pose[o + k] = (1 - share) * p[i + k] + share * (k < 3 ? 1 : sign) * p[j + k];
        if (k > 2) norm += this.pose[o + k] ** 2;
      }
      for (let k = 3; k < 7; k++) this.pose[o + k] /= Math.sqrt(norm);
    }
  }

  value(name, column) { // of an array over time, now
    const array = this.arrays[name], width = array.width;
    return (1 - this.share) * array[this.row * width + column] + this.share * array[this.next * width + column];
  }

  point(body, p) { // of a body's frame, in the world
    const o = 7 * body, [px, py, pz, x, y, z, w] = this.pose.subarray(o, o + 7);
    const cx = 2 * (y * p[2] - z * p[1]), cy = 2 * (z * p[0] - x * p[2]), cz = 2 * (x * p[1] - y * p[0]);
    return [px + p[0] + w * cx + y * cz - z * cy, py + p[1] + w * cy + z * cx - x * cz,
            pz + p[2] + w * cz + x * cy - y * cx];
  }

  centre() {
    const { masses } = this.scenery;
    const sum = [0, 0, 0];
    let total = 0;
    masses.forEach((m, b) => { total += m; for (let k = 0; k < 3; k++) sum[k] += m * this.pose[7 * b + k]; });
    return sum.map((s) => s / total);
  }

  centreAt(row) {
    const { masses } = this.scenery, p = this.arrays.poses;
    const sum = [0, 0, 0];
    let total = 0;
    masses.forEach((m, b) => {
      total += m;
      for (let k = 0; k < 3; k++) sum[k] += m * p[(row * this.bodies + b) * 7 + k];
    });
    return sum.map((s) => s / total);
  }

  node(n) { return this.point(this.scenery.nodes.bodies[n], this.scenery.nodes.points[n]); }
}
