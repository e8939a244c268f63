const bytesOf = text => {
  const raw = atob(text), bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; ++k) bytes[k] = raw.charCodeAt(k);
  return bytes.buffer;
};

/// A number of IEEE 754 binary16; those beyond 60000 stand for none.
const fromHalf = bits => {
  const sign = bits & 0x8000 ? -1 : 1, exponent = bits >> 10 & 31, fraction = bits & 1023;
  const size = exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24;
  return size > 60000 ? NaN : sign * size;
};

function program(gl, vertex, fragment) {
  const made = gl.createProgram();
  for (const [type, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error("the shaders do not link");
  const uniform = {};
  for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); ++k) {
    const name = gl.getActiveUniform(made, k).name;
    uniform[name] = gl.getUniformLocation(made, name);
  }
  return {made, uniform};
}

/// Quadrilaterals of four vertices each: a buffer of their corners, others of what belongs to each bead or bond.
/// Not instances, which are drawn one by one in software, and slowly elsewhere where they are so small.
function quads(gl, layout) {
  const array = gl.createVertexArray(), buffers = layout.map(() => gl.createBuffer());
  const corners = gl.createBuffer(), order = gl.createBuffer();
  let room = 0;
  gl.bindVertexArray(array);
  [{components: 2, type: gl.BYTE}, ...layout].forEach(({components, type, normalised = false}, k) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, k ? buffers[k - 1] : corners);
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, components, type, normalised, 0, 0);
  });
  const make_room = count => {
    if (count <= room) return;
    room = count;
    const at = new Int8Array(8 * count), vertices = new Uint32Array(6 * count);
    for (let k = 0; k < count; ++k) {
      at.set([-1, -1, 1, -1, -1, 1, 1, 1], 8 * k);
      [0, 1, 2, 2, 1, 3].forEach((corner, n) => vertices[6 * k + n] = 4 * k + corner);
    }
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, corners);
    gl.bufferData(gl.ARRAY_BUFFER, at, gl.STATIC_DRAW);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, order);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
  };
  const fill = (k, data) => {
    const {components} = layout[k], four = new data.constructor(4 * data.length);
    for (let n = 0; n < four.length; ++n)
      four[n] = data[components * Math.floor(n / components / 4) + n % components];
    make_room(data.length / components);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[k]);
    gl.bufferData(gl.ARRAY_BUFFER, four, gl.DYNAMIC_DRAW);
  };
  const draw = count => {
    gl.bindVertexArray(array);
    gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 0);
  };
  return {fill, draw};
}

/// The numbers of a moment, unpacked when it is first shown.
function unpacked(moment) {
  if (moment.ready) return moment.ready;
  return moment.ready = {
    centres: new Uint16Array(bytesOf(moment.centres)),
    values: moment.values.map(text => new Uint16Array(bytesOf(text))),
    states: new Uint8Array(bytesOf(moment.states)),
    pair_values: moment.pair_values.map(text => new Uint16Array(bytesOf(text)))
  };
}

/// Right, up and towards the eye, in the specimen's axes, whose z stays upright.
function turned(azimuth, elevation) {
  const ca = Math.cos(azimuth), sa = Math.sin(azimuth), ce = Math.cos(elevation), se = Math.sin(elevation);
  return [[ca, sa, 0], [-sa * se, ca * se, ce], [sa * ce, -ca * ce, se]];
}

const product = (rows, p) => rows.map(row => row[0] * p[0] + row[1] * p[1] + row[2] * p[2]);

class Specimen {
  constructor(figure, data) {
    this.data = data;
    this.canvas = figure.querySelector("canvas");
    this.gl = this.canvas.getContext("webgl2", {antialias: false, preserveDrawingBuffer: true});
    if (!this.gl) throw new Error("no WebGL 2");
    this.pairs = new Uint32Array(bytesOf(data.pairs));
    this.diameters = new Float32Array(bytesOf(data.diameters));
    this.maps = {};
    for (const [name, text] of Object.entries(data.maps)) this.maps[name] = new Uint8Array(bytesOf(text));
    this.measure();
    this.moment = data.moments.length - 1;
    this.field = 0;
    this.pair_field = -1;
    this.ranges = data.fields.map(field => [field.low, field.high]);
    this.swell = 1;
    this.states = {0: true, 1: true, 2: false};
    this.section = "none";
    this.cut_at = 0.5;
    this.chosen = -1;
    this.coarse = 1;
    this.drawn_at = 0;
    this.reset();
    this.prepare();
    add_controls(this, figure);
    listen(this);
    this.refill();
  }

  /// Middle and size of the specimen as it is at first: beads that have flown off do not make it small. `depth` has all.
  measure() {
    const {low, size, moments} = this.data, {centres} = unpacked(moments[0]), widest = Math.max(...this.diameters);
    this.widest = widest;
    const ends = [0, 1, 2].map(axis => {
      let least = 65535, most = 0;
      for (let k = axis; k < centres.length; k += 3) {
        least = Math.min(least, centres[k]);
        most = Math.max(most, centres[k]);
      }
      return [least, most].map(v => low[axis] + v / 65535 * size[axis]);
    });
    this.middle = ends.map(([least, most]) => (least + most) / 2);
    this.size = ends.map(([least, most]) => most - least);
    this.radius = Math.hypot(...this.size) / 2 + widest;
    const farthest = this.middle.map((v, k) => Math.max(v - low[k], low[k] + size[k] - v));
    this.depth = Math.hypot(...farthest) + widest;
  }

  reset() {
    this.azimuth = 0.5;
    this.elevation = 0.3;
    this.zoom = 1.1;
    this.shift = [0, 0];
  }

  prepare() {
    const gl = this.gl;
    this.beads = program(gl, beadVertex, beadFragment);
    this.bonds = program(gl, bondVertex, bondFragment);
    const half = gl.HALF_FLOAT, whole = gl.UNSIGNED_SHORT;
    this.bead_data = quads(gl, [
      {components: 3, type: whole, normalised: true}, {components: 1, type: gl.FLOAT},
      {components: 1, type: half}
    ]);
    this.bead_data.fill(1, this.diameters.map(d => d / 2));
    this.bond_data = quads(gl, [
      {components: 3, type: whole, normalised: true}, {components: 3, type: whole, normalised: true},
      {components: 1, type: half}, {components: 1, type: gl.UNSIGNED_BYTE}
    ]);
    const maps = Object.values(this.maps), texels = new Uint8Array(maps.flatMap(map => [...map]));
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGB8, 65, maps.length, 0, gl.RGB, gl.UNSIGNED_BYTE, texels);
    for (const [key, value] of [[gl.TEXTURE_MIN_FILTER, gl.LINEAR], [gl.TEXTURE_MAG_FILTER, gl.LINEAR],
                                [gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE], [gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE]])
      gl.texParameteri(gl.TEXTURE_2D, key, value);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(1, 1, 1, 1);
  }

  /// Hands over what depends on moment, field and which bonds are shown.
  refill() {
    const now = unpacked(this.data.moments[this.moment]);
    this.bead_data.fill(0, now.centres);
    this.bead_data.fill(2, now.values[this.field]);
    const visible = [];
    for (let k = 0; k < now.states.length; ++k)
      if (this.states[now.states[k]] && (now.states[k] != 1 || this.near(k))) visible.push(k);
    const ends = [0, 1].map(end => {
      const at = new Uint16Array(3 * visible.length);
      visible.forEach((pair, k) => {
        const bead = this.pairs[2 * pair + end];
        for (let axis = 0; axis < 3; ++axis) at[3 * k + axis] = now.centres[3 * bead + axis];
      });
      return at;
    });
    this.bond_data.fill(0, ends[0]);
    this.bond_data.fill(1, ends[1]);
    const values = this.pair_field < 0 ? null : now.pair_values[this.pair_field];
    this.bond_data.fill(2, Uint16Array.from(visible, k => values ? values[k] : 0));
    this.bond_data.fill(3, Uint8Array.from(visible, k => now.states[k]));
    this.bonds_shown = visible.length;
    say(this);
    this.ask();
  }

  /// Whether the ends of a bond are still neighbours: lines to beads that have flown off say nothing.
  near(pair) {
    const [a, b] = [0, 1].map(end => this.centre(this.pairs[2 * pair + end]));
    return Math.hypot(...a.map((v, k) => v - b[k])) < 3 * this.widest;
  }

  /// Draws once before the browser's next picture, however much changes until then. Where pictures come too
  /// slowly while the specimen turns, they have fewer pixels, until it rests.
  ask() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(now => {
      this.asked = false;
      const since = now - this.drawn_at;
      if (since > 50 && since < 1000) this.coarse = Math.min(4, this.coarse * 1.4);
      if (since < 25) this.coarse = Math.max(1, this.coarse / 1.1);
      this.drawn_at = now;
      this.draw(this.coarse);
      clearTimeout(this.rest);
      if (this.coarse > 1) this.rest = setTimeout(() => this.draw(1), 200);
    });
  }

  scale() {
    const per_mm = this.zoom / this.radius, {width, height} = this.canvas;
    return width > height ? [per_mm * height / width, per_mm] : [per_mm, per_mm * width / height];
  }

  /// The section as seen: what lies beyond n·p = d, p from the middle of the specimen, is cut away.
  cut(rows) {
    if (this.section == "none") return [0, 0, 0, 1];
    const normal = {x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1], eye: [0, 0, 1]}[this.section];
    const reach = this.section == "eye" ? this.radius
                                        : this.size["xyz".indexOf(this.section)] / 2 + this.diameters[0] / 2;
    return [...(this.section == "eye" ? normal : product(rows, normal)), (2 * this.cut_at - 1) * reach];
  }

  draw(coarse = 1) {
    const gl = this.gl, ratio = (window.devicePixelRatio || 1) / coarse;
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (this.canvas.width != width || this.canvas.height != height)
      Object.assign(this.canvas, {width, height});
    gl.viewport(0, 0, width, height);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const rows = turned(this.azimuth, this.elevation), cut = this.cut(rows), scale = this.scale();
    const use = ({made, uniform}, field, range) => {
      gl.useProgram(made);
      gl.uniform3fv(uniform.low, this.data.low);
      gl.uniform3fv(uniform.size, this.data.size);
      gl.uniform3fv(uniform.middle, this.middle);
      gl.uniformMatrix3fv(uniform.turn, true, rows.flat());
      gl.uniform2fv(uniform.scale, scale);
      gl.uniform2fv(uniform.shift, this.shift);
      gl.uniform1f(uniform.depth, this.depth);
      gl.uniform4fv(uniform.cut, cut);
      gl.uniform1f(uniform.unit, field ? field.unit_of_value : 1);
      gl.uniform2fv(uniform.range, range);
      const maps = Object.keys(this.maps);
      gl.uniform1f(uniform.row, field ? (0.5 + maps.indexOf(field.map)) / maps.length : 0);
    };
    if (this.swell > 0) {
      use(this.beads, this.data.fields[this.field], this.ranges[this.field]);
      gl.uniform1f(this.beads.uniform.swell, this.swell);
      gl.uniform1i(this.beads.uniform.chosen, this.chosen);
      this.bead_data.draw(this.data.ids.length);
    }
    if (this.bonds_shown > 0) {
      const field = this.data.pair_fields[this.pair_field];
      use(this.bonds, field, field ? [field.low, field.high] : [0, 1]);
      gl.uniform1f(this.bonds.uniform.width, 0.08 * this.diameters[0]);
      gl.uniform1i(this.bonds.uniform.by_value, field ? 1 : 0);
      this.bond_data.draw(this.bonds_shown);
    }
  }

  centre(bead, moment = this.moment) {
    const now = unpacked(this.data.moments[moment]);
    return [0, 1, 2].map(
        axis => this.data.low[axis] + now.centres[3 * bead + axis] / 65535 * this.data.size[axis]);
  }

  /// The bead that is seen at a place of the window; -1: none.
  bead_at(x, y) {
    const box = this.canvas.getBoundingClientRect(), scale = this.scale();
    const at = [
      (2 * (x - box.left) / box.width - 1) / scale[0] - this.shift[0],
      (1 - 2 * (y - box.top) / box.height) / scale[1] - this.shift[1]
    ];
    const rows = turned(this.azimuth, this.elevation), cut = this.cut(rows);
    let nearest = -Infinity, found = -1;
    for (let bead = 0; bead < this.data.ids.length; ++bead) {
      const eye = product(rows, this.centre(bead).map((v, k) => v - this.middle[k]));
      const reach = this.swell * this.diameters[bead] / 2;
      const beside = (at[0] - eye[0]) ** 2 + (at[1] - eye[1]) ** 2;
      if (beside > reach * reach) continue;
      const half = Math.sqrt(reach * reach - beside);
      let z = eye[2] + half;
      const beyond = cut[0] * at[0] + cut[1] * at[1] + cut[2] * z - cut[3];
      if (beyond > 0) {
        if (cut[2] <= 0) continue;
        z -= beyond / cut[2];
        if (Math.abs(z - eye[2]) > half) continue;
      }
      if (z > nearest) [nearest, found] = [z, bead];
    }
    return found;
  }

  choose(bead) {
    this.chosen = bead;
    say(this);
    this.ask();
  }

  turn(azimuth, elevation) {
    this.azimuth += azimuth;
    this.elevation = Math.min(Math.PI / 2, Math.max(-Math.PI / 2, this.elevation + elevation));
    this.ask();
  }

  zoom_by(factor) {
    this.zoom = Math.min(50, Math.max(0.2, this.zoom * factor));
    this.ask();
  }
}
