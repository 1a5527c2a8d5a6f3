// The bodies of a run, moving: triangles with a depth for every pixel, drawn by this script alone,
// so that a page shows them on any machine, with or without a graphics processor.
async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}
// The block of numbers, in the order in which bodies_page.py packs it.
class Block {
  constructor(buffer) { this.buffer = buffer; this.at = 0; }
  words(count) {
    const out = new Uint16Array(this.buffer, this.at, count);
    this.at += 4 * Math.ceil(count / 2);
    return out;
  }
  counts(count) {
    const out = new Uint32Array(this.buffer, this.at, count);
    this.at += 4 * count;
    return out;
  }
  states(number, count) {  // each state is told as what it adds to the one before
    const all = this.words(number * count), rows = [];
    for (let k = count; k < all.length; k++) all[k] += all[k - count];
    for (let k = 0; k < number; k++) rows.push(all.subarray(k * count, (k + 1) * count));
    return rows;
  }
}
function bodyFrom(data, told, block) {
  const axes = data.dimension === 3 ? 3 : 2, states = data.times.length, n = told.nodes;
  const rest = new Float32Array(3 * n);
  for (let i = 0; i < axes; i++) {
    block.words(n).forEach((q, k) => {
      rest[3 * k + i] = told.low[i] + q / 65535 * (told.high[i] - told.low[i]);
    });
  }
  const triangles = block.counts(3 * told.triangles), edges = block.counts(2 * told.edges);
  const moved = [], values = {};
  for (let i = 0; i < axes; i++) moved.push(block.states(states, n));
  for (const key of told.keys) values[key] = block.states(states, n);
  return Object.assign({}, told, {rest: rest, triangles: triangles, edges: edges, moved: moved,
    shown: true, values: values, place: new Float32Array(3 * n), screen: new Float32Array(3 * n)});
}
function channels(colour) {
  return [1, 3, 5].map((k) => parseInt(colour.slice(k, k + 2), 16));
}
// Signed: engines of browsers are slow with larger whole numbers.
function packedColour(r, g, b) { return 255 << 24 | b << 16 | g << 8 | r; }
// Between stops, linearly; t from 0 to 1.
function rampColour(stops, t) {
  const at = Math.min(stops.length - 1.000001, Math.max(0, t * (stops.length - 1)));
  const k = Math.floor(at), one = channels(stops[k]), other = channels(stops[k + 1]);
  return one.map((v, i) => Math.round(v + (at - k) * (other[i] - v)));
}
// A colour of the 256 of a scale, not quite a whole number.
function levelOf(shade, value) {
  const part = (value - shade.low) / (shade.high - shade.low);
  return 0.25 + 255.5 * Math.max(0, Math.min(1, part));
}
const LEVELS = 32;
function lit(colour, level) {
  const light = 0.42 + 0.58 * level / (LEVELS - 1);
  return packedColour(...colour.map((v) => Math.round(v * light)));
}
function table(colourOf) {  // of every level of light 256 colours
  const out = new Int32Array(LEVELS * 256);
  for (let k = 0; k < 256; k++) {
    const colour = colourOf(k / 255);
    for (let level = 0; level < LEVELS; level++) out[level * 256 + k] = lit(colour, level);
  }
  return out;
}
// Pixels, each with the depth of what it shows.
class Picture {
  constructor(width, height) {
    this.width = width; this.height = height;
    this.image = new ImageData(width, height);
    this.pixels = new Int32Array(this.image.data.buffer);
    this.depth = new Float32Array(width * height);
  }
  clear() { this.pixels.fill(0); this.depth.fill(-Infinity); }
  // Of values between 0 and 255 at its corners: colours from `first` on.
  triangle(p, a, b, c, colours, first, va, vb, vc) {
    const {width, height, pixels, depth} = this;
    const ax = p[3 * a], ay = p[3 * a + 1], bx = p[3 * b], by = p[3 * b + 1];
    const cx = p[3 * c], cy = p[3 * c + 1];
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
    if (!area) return;
    const y0 = Math.max(0, Math.ceil(Math.min(ay, by, cy)));
    const y1 = Math.min(height - 1, Math.floor(Math.max(ay, by, cy)));
    const one = 1 / area, az = p[3 * a + 2], bz = p[3 * b + 2], cz = p[3 * c + 2];
    const du = (by - cy) * one, dv = (cy - ay) * one, dw = -du - dv;
    const dz = du * az + dv * bz + dw * cz, dt = du * va + dv * vb + dw * vc;
    for (let y = y0; y <= y1; y++) {
      const u = (bx * (cy - y) - cx * (by - y)) * one, v = (cx * (ay - y) - ax * (cy - y)) * one;
      const w = 1 - u - v;
      // Between which columns all three weights are positive.
      let from = 0, to = width - 1;
      if (du > 0) from = Math.max(from, -u / du); else if (du < 0) to = Math.min(to, -u / du);
      else if (u < 0) continue;
      if (dv > 0) from = Math.max(from, -v / dv); else if (dv < 0) to = Math.min(to, -v / dv);
      else if (v < 0) continue;
      if (dw > 0) from = Math.max(from, -w / dw); else if (dw < 0) to = Math.min(to, -w / dw);
      else if (w < 0) continue;
      from = Math.ceil(from - 1e-3);
      const last = y * width + Math.floor(to + 1e-3);
      let z = u * az + v * bz + w * cz + from * dz;
      let t = first + u * va + v * vb + w * vc + from * dt;
      for (let at = y * width + from; at <= last; at++, z += dz, t += dt) {
        if (z <= depth[at]) continue;
        depth[at] = z;
        pixels[at] = colours[t | 0];
      }
    }
  }
  line(p, a, b, bias, part, bare) {
    const {width, height, pixels, depth} = this;
    const ax = p[3 * a], ay = p[3 * a + 1], az = p[3 * a + 2];
    const dx = p[3 * b] - ax, dy = p[3 * b + 1] - ay, dz = p[3 * b + 2] - az;
    const steps = Math.ceil(Math.max(Math.abs(dx), Math.abs(dy), 1));
    if (steps > 4 * (width + height)) return;
    for (let k = 0; k <= steps; k++) {
      const x = Math.round(ax + dx * k / steps), y = Math.round(ay + dy * k / steps);
      if (x < 0 || y < 0 || x >= width || y >= height) continue;
      const at = y * width + x, z = az + dz * k / steps + bias;
      const old = pixels[at];
      if (z < depth[at] || (!old && !bare)) continue;
      depth[at] = z;
      pixels[at] = old ? packedColour((old & 255) * part, (old >> 8 & 255) * part,
        (old >> 16 & 255) * part) : packedColour(128, 128, 128);
    }
  }
}
class Stage {
  constructor(data, buffer) {
    this.take(data, buffer);
    this.canvas = document.getElementById("bodies");
    this.state = 0; this.shade = data.shades.length ? data.shades[0].key : ""; this.magnify = 1;
    this.picture = null; this.moving = false; this.waits = false; this.gauge = null;
    this.watchers = []; this.tables = {};
    this.home();
  }
  take(data, buffer) {
    this.data = data;
    const block = new Block(buffer);
    this.bodies = data.bodies.map((told) => bodyFrom(data, told, block));
    this.levels = new Float32Array(Math.max(...data.bodies.map((body) => body.nodes)));
  }
  home() {
    this.turn = this.front();
    this.zoom = 1; this.shift = [0, 0];
  }
  front() { return this.data.dimension === 3 ? [0.55, 0.35] : [0, Math.PI / 2]; }
  axes() {  // of the screen: to the right, up, towards the viewer
    const [a, e] = this.turn;
    const right = [Math.cos(a), Math.sin(a), 0];
    const up = [-Math.sin(a) * -Math.sin(e) * -1, Math.cos(a) * Math.sin(e), Math.cos(e)];
    up[0] = -Math.sin(a) * Math.sin(e);
    const out = [Math.sin(a) * Math.cos(e), -Math.cos(a) * Math.cos(e), Math.sin(e)];
    return [right, up, out];
  }
  extent(axes) {  // half the width and height of all that is ever shown
    const {low, high} = this.data;
    return [0, 1].map((i) => 0.5 * [0, 1, 2].reduce((sum, k) =>
      sum + Math.abs(axes[i][k]) * (high[k] - low[k]), 0));
  }
  scaleOf(width, height) {
    const turned = this.turn;
    this.turn = this.front();
    const [w, h] = this.extent(this.axes());
    this.turn = turned;
    return this.zoom * 0.47 * Math.min(width / (w || 1), height / (h || w || 1));
  }
  place(body) {
    const {place, rest, moved, reach} = body, mean = body.means[this.state], n = body.nodes;
    const factor = this.magnify * reach;
    for (let i = 0; i < moved.length; i++) {
      const row = moved[i][this.state];
      for (let k = 0; k < n; k++) {
        place[3 * k + i] = rest[3 * k + i] + mean[i] + factor * (row[k] / 32767.5 - 1);
      }
    }
  }
  project(body, width, height, scale) {
    const [right, up, out] = this.axes(), {low, high} = this.data;
    const c = [0, 1, 2].map((i) => 0.5 * (low[i] + high[i]));
    const {place, screen, nodes} = body, ratio = width / this.canvas.clientWidth;
    for (let k = 0; k < nodes; k++) {
      const x = place[3 * k] - c[0], y = place[3 * k + 1] - c[1], z = place[3 * k + 2] - c[2];
      screen[3 * k] = width / 2 + ratio * this.shift[0] +
        scale * (right[0] * x + right[1] * y + right[2] * z);
      screen[3 * k + 1] = height / 2 + ratio * this.shift[1] -
        scale * (up[0] * x + up[1] * y + up[2] * z);
      screen[3 * k + 2] = scale * (out[0] * x + out[1] * y + out[2] * z);
    }
  }
  shadeOf(body) {  // how values of the body become colours; null: the body's own colour
    const shade = this.data.shades.find((each) => each.key === this.shade);
    return shade && body.keys.includes(shade.key) ? shade : null;
  }
  light(s, a, b, c) {
    if (this.data.dimension < 3) return LEVELS - 1;
    const ux = s[3 * b] - s[3 * a], uy = s[3 * b + 1] - s[3 * a + 1];
    const uz = s[3 * b + 2] - s[3 * a + 2];
    const vx = s[3 * c] - s[3 * a], vy = s[3 * c + 1] - s[3 * a + 1];
    const vz = s[3 * c + 2] - s[3 * a + 2];
    let x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    const size = Math.hypot(x, y, z) || 1, side = z < 0 ? -1 : 1;
    x *= side / size; y *= side / size; z *= side / size;
    return Math.round((LEVELS - 1) * Math.max(0, Math.min(1, 0.3 * x - 0.4 * y + 0.87 * z)));
  }
  paint(body) {
    const shade = this.shadeOf(body), s = body.screen, picture = this.picture;
    const plain = this.shade ? "#9aa4b2" : themed(body.colour);
    const colours = shade ? this.colours(shade) : this.one(plain);
    const row = shade ? body.values[shade.key][this.state] : null;
    const from = shade ? shade.least : 0, span = shade ? (shade.most - shade.least) / 65535 : 0;
    const t = body.triangles, levels = this.levels;
    for (let k = 0; row && k < body.nodes; k++) {
      levels[k] = levelOf(shade, from + row[k] * span);
    }
    for (let k = 0; k < t.length; k += 3) {
      const a = t[k], b = t[k + 1], c = t[k + 2], first = this.light(s, a, b, c) * 256;
      if (row) picture.triangle(s, a, b, c, colours, first, levels[a], levels[b], levels[c]);
      else picture.triangle(s, a, b, c, colours, first, 0, 0, 0);
    }
  }
  one(colour) {
    if (!this.tables[colour]) this.tables[colour] = table(() => channels(colour));
    return this.tables[colour];
  }
  stops(shade) {  // nothing looks like the ground
    const {plain, signed, signed_dark} = this.data.ramps;
    return shade.low >= 0 ? plain : scheme.matches ? signed_dark : signed;
  }
  colours(shade) {
    const stops = this.stops(shade);
    if (!this.tables[shade.key]) this.tables[shade.key] = table((t) => rampColour(stops, t));
    return this.tables[shade.key];
  }
  rims(body, ratio) {  // edges, where facets are large enough to be told apart
    const e = body.edges, s = body.screen;
    let length = 0;
    const step = 2 * Math.max(1, Math.floor(e.length / 400));
    let seen = 0;
    for (let k = 0; k < e.length; k += step, seen++) {
      length += Math.hypot(s[3 * e[k]] - s[3 * e[k + 1]], s[3 * e[k] + 1] - s[3 * e[k + 1] + 1]);
    }
    if (!seen || (length / seen < 5 * ratio && !body.strip)) return;
    const bias = 3e-3 * this.picture.width;  // lines are on whole pixels, beside their facets
    for (let k = 0; k < e.length; k += 2) this.picture.line(s, e[k], e[k + 1], bias, 0.72,
      !body.triangles.length);
  }
  draw() {
    const box = this.canvas.getBoundingClientRect();
    if (!box.width) return;
    const own = window.devicePixelRatio || 1, ratio = this.moving ? Math.min(own, 1.5) :
      Math.min(Math.max(2, own), Math.sqrt(3e6 / (box.width * box.height)));
    const width = Math.round(box.width * ratio), height = Math.round(box.height * ratio);
    if (!this.picture || this.picture.width !== width || this.picture.height !== height) {
      this.picture = new Picture(width, height);
      this.canvas.width = width; this.canvas.height = height;
    }
    this.picture.clear();
    const scale = this.scaleOf(width, height);
    for (const body of this.bodies.filter((each) => each.shown)) {
      this.place(body);
      this.project(body, width, height, scale);
      this.paint(body);
      this.rims(body, ratio);
    }
    const context = this.canvas.getContext("2d", {willReadFrequently: true});
    context.putImageData(this.picture.image, 0, 0);
    this.mark(context, ratio);
  }
  mark(context, ratio) {  // the place of the gauge
    if (!this.gauge || !this.gauge.body.shown) return;
    const s = this.gauge.body.screen, k = this.gauge.node;
    context.lineWidth = 2 * ratio;
    context.strokeStyle = style("--ink");
    context.beginPath();
    context.arc(s[3 * k], s[3 * k + 1], 6 * ratio, 0, 2 * Math.PI);
    context.stroke();
  }
  redraw() {
    if (this.waits) return;
    this.waits = true;
    requestAnimationFrame(() => { this.waits = false; this.draw(); });
  }
  show(state) {
    this.state = Math.max(0, Math.min(this.data.times.length - 1, state));
    this.redraw();
    for (const watcher of this.watchers) watcher();
  }
  // The node that is seen nearest to a place of the canvas, in its own pixels.
  nearest(x, y) {
    const ratio = this.canvas.width / this.canvas.clientWidth;
    let best = null, least = (14 * ratio) ** 2;
    const touched = this.picture.depth[Math.round(y * ratio) * this.picture.width +
      Math.round(x * ratio)];
    const front = touched > -Infinity ? touched : Infinity, deep = 0.03 * this.canvas.width;
    for (const body of this.bodies.filter((each) => each.shown)) {
      for (let k = 0; k < body.nodes; k++) {
        const s = body.screen;
        if (this.data.dimension === 3 && Math.abs(s[3 * k + 2] - front) > deep) continue;
        const far = (s[3 * k] - x * ratio) ** 2 + (s[3 * k + 1] - y * ratio) ** 2;
        if (far < least) { least = far; best = {body: body, node: k}; }
      }
    }
    return best;
  }
}
