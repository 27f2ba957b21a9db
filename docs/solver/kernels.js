// The kernels, compiled from the package's own, in one memory with the page; what an arm has there is
// given back when another comes.

const FLOATS = 8, MEMORY = 128;  // pages of 64 KiB
const page = JSON.parse(document.getElementById("page").textContent);
const kernels = {};
let memory, bottom, top_;

async function loadKernels({code, entries}) {
  const bytes = Uint8Array.from(atob(code), c => c.charCodeAt(0));
  const made = (await WebAssembly.instantiate(bytes, {js: {fmod: (x, y) => x % y}})).instance.exports;
  made.memory.grow(MEMORY);
  memory = made.memory.buffer;
  top_ = Math.ceil(made.__heap_base.value / 16) * 16;
  const places = new Uint32Array(memory, made.entries.value, entries.length + 1);
  entries.forEach((name, k) => {
    const kernel = made.__indirect_function_table.get(places[k + 1]);
    kernels[name] = (...given) => kernel(...given.map(x => x.byteOffset ?? Number(x)));
  });
  bottom = top_;
}

// An array in the memory of the kernels, filled with numbers or zeros.
function floats(size, values = []) {
  const made = new Float64Array(memory, top_, size).fill(0);
  top_ += FLOATS * size;
  made.set(values.flat());
  return made;
}

function integers(size, values = []) {
  const made = new BigInt64Array(floats(size).buffer, top_ - FLOATS * size, size);
  values.forEach((v, k) => { made[k] = BigInt(v); });
  return made;
}

// Arrays for the solutions of one pose.
function outputs(kmax, n) {
  const out = {kmax, n, q: floats(kmax * n), residual: floats(kmax)};
  return Object.assign(out, {count: integers(1), branch: integers(kmax), free: integers(kmax)});
}

const handed = out => [out.q, out.residual, out.count, out.branch, out.free];

// Members of singular families inside the limits, for those that are outside of them.
function bringInside({n, tables, pose, size, middle, pointOnly}, out, within) {
  if (within) kernels.families_inside(n + 1, n, n, 1, out.kmax, ...tables, page.slack, page.tasks[pointOnly ? "position" : "pose"], size, middle, pose, ...handed(out));
}

function solutionsOf(out) {
  return Array.from({length: Number(out.count[0])}, (_, k) => ({
    q: Array.from(out.q.subarray(out.n * k, out.n * (k + 1))),
    residual: out.residual[k],
    free: Array.from({length: out.n}, (_, i) => i).filter(i => Number(out.free[k]) >> i & 1),
  }));
}

// How far q (n) may be doubted: counts below zero say so.
function settle(out) {
  const count = Number(out.count[0]);
  if (count < 0) out.count[0] = BigInt((-1 - count) % page.deep);
  return count < 0;
}
