// Shows the GLB that stands in this page: drag to turn, wheel or pinch to come nearer, light and envelope by sliders.
(() => {
  'use strict';
  const root = document.documentElement, canvas = document.querySelector('#stage canvas');
  const hint = document.querySelector('#stage p');
  const say = (state, text) => { root.dataset.viewer = state; if (text) hint.textContent = text; };
  const gl = canvas.getContext('webgl2', { antialias: true, preserveDrawingBuffer: true });
  if (!gl) return say('none', 'This browser cannot show the surface (no WebGL 2); the pictures below can be seen.');

  // The GLB: a head, a chunk of JSON, a chunk of numbers.
  const text = atob(document.getElementById('surface').textContent.trim());
  const bytes = Uint8Array.from(text, c => c.charCodeAt(0)), view = new DataView(bytes.buffer);
  const jsonLength = view.getUint32(12, true), binAt = 20 + jsonLength + 8;
  const glb = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonLength)));
  const array = (id, Type, size) => {
    const a = glb.accessors[id], v = glb.bufferViews[a.bufferView];
    return new Type(bytes.buffer.slice(binAt + (v.byteOffset || 0), binAt + (v.byteOffset || 0) + v.byteLength), 0, a.count * size);
  };

  const shader = (kind, source) => {
    const s = gl.createShader(kind);
    gl.shaderSource(s, '#version 300 es\nprecision highp float;\n' + source);
    gl.compileShader(s);
    if (!gl.getShaderParameter(s, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(s));
    return s;
  };
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `
    layout(location=0) in vec3 place; layout(location=1) in vec3 normal; layout(location=2) in vec4 tint;
    uniform mat3 turn; uniform vec3 middle, lift, window; uniform vec2 pan; out vec3 n; out vec3 colour;
    void main() {
      vec3 p = turn * (place + lift - middle);
      n = turn * normal; colour = tint.rgb;
      gl_Position = vec4((p.xy + pan) * window.xy, -p.z * window.z, 1.0);
    }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
    in vec3 n; in vec3 colour; uniform vec3 light; out vec4 seen;
    void main() {
      vec3 m = normalize(gl_FrontFacing ? n : -n);
      float level = max(light.z, 0.25);
      vec3 linear = colour * (0.06 + 0.62 * max(dot(m, light), 0.0) / level + 0.18 * max(m.z, 0.0));
      seen = vec4(pow(clamp(linear, 0.0, 1.0), vec3(1.0 / 2.2)), 1.0);
    }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  const place = name => gl.getUniformLocation(program, name);

  const low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9], parts = [];
  for (const node of glb.nodes) {
    if (node.mesh === undefined) continue;
    const primitive = glb.meshes[node.mesh].primitives[0], at = primitive.attributes, box = glb.accessors[at.POSITION];
    const vao = gl.createVertexArray();
    gl.bindVertexArray(vao);
    const fill = (slot, data, size, type, normalized) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(slot);
      gl.vertexAttribPointer(slot, size, type, normalized, 0, 0);
    };
    fill(0, array(at.POSITION, Float32Array, 3), 3, gl.FLOAT, false);
    fill(1, array(at.NORMAL, Float32Array, 3), 3, gl.FLOAT, false);
    if (at.COLOR_0 !== undefined) fill(2, array(at.COLOR_0, Uint16Array, 4), 4, gl.UNSIGNED_SHORT, true);
    else gl.vertexAttrib4f(2, 0.6, 0.53, 0.45, 1);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, array(primitive.indices, Uint32Array, 1), gl.STATIC_DRAW);
    for (let k = 0; k < 3; ++k) { low[k] = Math.min(low[k], box.min[k]); high[k] = Math.max(high[k], box.max[k]); }
    parts.push({ name: node.name, vao, count: glb.accessors[primitive.indices].count, shown: true });
  }
  const middle = low.map((l, k) => (l + high[k]) / 2), size = low.map((l, k) => high[k] - l);
  const far = Math.hypot(...size);

  // A row-major 3x3 turn; turning is about the axes of the screen.
  const times = (a, b) => { const c = []; for (let r = 0; r < 3; ++r) for (let k = 0; k < 3; ++k)
    c[3 * r + k] = a[3 * r] * b[k] + a[3 * r + 1] * b[3 + k] + a[3 * r + 2] * b[6 + k]; return c; };
  const aboutX = t => [1, 0, 0, 0, Math.cos(t), -Math.sin(t), 0, Math.sin(t), Math.cos(t)];
  const aboutY = t => [Math.cos(t), 0, Math.sin(t), 0, 1, 0, -Math.sin(t), 0, Math.cos(t)];
  const upright = [1, 0, 0, 0, 1, 0, 0, 0, 1];
  let turn = upright, zoom = 1, pan = [0, 0], lift = 0, angle = 315, queued = false;

  // Labels of lines and notes, over the picture; those that look away are not seen.
  const pins = JSON.parse(document.getElementById('pins').textContent).map(pin => {
    const label = Object.assign(document.createElement('span'), { className: 'pin', textContent: pin.label, title: pin.text });
    canvas.parentElement.append(label);
    return { ...pin, element: label };
  });
  let showPins = true;
  const turned = v => [0, 1, 2].map(r => turn[3 * r] * v[0] + turn[3 * r + 1] * v[1] + turn[3 * r + 2] * v[2]);
  const placePins = (scale, w, h, panY) => {
    for (const pin of pins) {
      const up = pin.envelope ? lift * size[1] * 1.1 : 0;
      const p = turned(pin.at.map((x, k) => x + (k === 1 ? up : 0) - middle[k]));
      const x = 0.5 + 0.5 * (p[0] + pan[0]) * scale / w, y = 0.5 - 0.5 * (p[1] + panY) * scale / h;
      const seen = showPins && turned(pin.normal)[2] > 0.15 && x > 0 && x < 1 && y > 0 && y < 1;
      Object.assign(pin.element.style, { display: seen ? 'block' : 'none', left: 100 * x + '%', top: 100 * y + '%' });
    }
  };

  const draw = () => {
    queued = false;
    const ratio = window.devicePixelRatio || 1, w = Math.round(canvas.clientWidth * ratio), h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== w || canvas.height !== h) { canvas.width = w; canvas.height = h; }
    gl.viewport(0, 0, w, h);
    gl.clearColor(0.063, 0.067, 0.075, 1);
    gl.enable(gl.DEPTH_TEST);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const scale = zoom * Math.min(1.8 * w / size[0], 1.8 * h / (size[1] * (1 + lift))) / 1;
    gl.uniform3f(place('window'), scale / w, scale / h, 0.4 / far);
    gl.uniform2f(place('pan'), pan[0], pan[1] - lift * size[1] * 0.5);
    gl.uniform3fv(place('middle'), middle);
    gl.uniformMatrix3fv(place('turn'), true, turn);
    placePins(scale, w, h, pan[1] - lift * size[1] * 0.5);
    const a = angle * Math.PI / 180, e = 25 * Math.PI / 180;
    gl.uniform3f(place('light'), Math.cos(e) * Math.sin(a), Math.cos(e) * Math.cos(a), Math.sin(e));
    for (const part of parts) {
      if (!part.shown) continue;
      gl.uniform3f(place('lift'), 0, part.name.startsWith('envelope') ? lift * size[1] * 1.1 : 0, 0);
      gl.bindVertexArray(part.vao);
      gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 0);
    }
  };
  const redraw = () => { if (!queued) { queued = true; requestAnimationFrame(draw); } };

  const fingers = new Map();
  canvas.addEventListener('pointerdown', e => { canvas.setPointerCapture(e.pointerId); fingers.set(e.pointerId, e); });
  for (const over of ['pointerup', 'pointercancel']) canvas.addEventListener(over, e => fingers.delete(e.pointerId));
  canvas.addEventListener('pointermove', e => {
    const before = fingers.get(e.pointerId);
    if (!before) return;
    const dx = e.clientX - before.clientX, dy = e.clientY - before.clientY;
    if (fingers.size === 2) {
      const other = [...fingers.values()].find(f => f.pointerId !== e.pointerId);
      const length = f => Math.hypot(f.clientX - other.clientX, f.clientY - other.clientY);
      zoom = Math.min(40, Math.max(0.3, zoom * length(e) / Math.max(1, length(before))));
    } else if (e.shiftKey || e.buttons === 2) {
      const mm = size[0] / canvas.clientWidth / zoom;
      pan = [pan[0] + dx * mm, pan[1] - dy * mm];
    } else {
      turn = times(aboutX(dy * 0.008 / Math.sqrt(zoom)), times(aboutY(dx * 0.008 / Math.sqrt(zoom)), turn));
    }
    fingers.set(e.pointerId, e);
    redraw();
  });
  canvas.addEventListener('contextmenu', e => e.preventDefault());
  canvas.addEventListener('wheel', e => {
    e.preventDefault();
    zoom = Math.min(40, Math.max(0.3, zoom * Math.exp(-e.deltaY * 0.0015)));
    redraw();
  }, { passive: false });
  window.addEventListener('resize', redraw);

  const desk = document.querySelector('.desk');
  const control = (label, input) => { const l = document.createElement('label'); l.append(input, ' ' + label); desk.append(l); };
  const slider = (label, max, start, use) => {
    const input = Object.assign(document.createElement('input'), { type: 'range', min: 0, max, value: start });
    input.addEventListener('input', () => { use(Number(input.value)); redraw(); });
    control(label, input);
  };
  for (const part of parts) {
    const input = Object.assign(document.createElement('input'), { type: 'checkbox', checked: true });
    input.addEventListener('change', () => { part.shown = input.checked; redraw(); });
    control(part.name, input);
  }
  if (parts.some(p => p.name.startsWith('envelope'))) slider('lift the envelope', 100, 0, v => { lift = v / 100; });
  slider('light from', 360, angle, v => { angle = v; });
  const button = (label, use) => {
    const b = Object.assign(document.createElement('button'), { textContent: label });
    b.addEventListener('click', () => { use(); redraw(); });
    desk.append(b);
  };
  if (pins.length > 0) {
    const input = Object.assign(document.createElement('input'), { type: 'checkbox', checked: true });
    input.addEventListener('change', () => { showPins = input.checked; redraw(); });
    control('lines and notes', input);
  }
  button('obverse', () => { turn = upright; zoom = 1; pan = [0, 0]; });
  button('reverse', () => { turn = aboutX(Math.PI); zoom = 1; pan = [0, 0]; });

  draw();
  const pixels = new Uint8Array(4 * canvas.width * canvas.height);
  gl.readPixels(0, 0, canvas.width, canvas.height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let lit = 0;
  for (let k = 0; k < pixels.length; k += 4) if (pixels[k] > 40) ++lit;
  root.dataset.lit = (400 * lit / pixels.length).toFixed(1);
  say('shown', 'Drag to turn, wheel to come nearer, shift and drag to move.');
})();
