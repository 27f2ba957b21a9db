// The panel: the table, the pose, its solutions, the joints.

const get = id => document.getElementById(id);
const KINDS_OF_JOINT = {"turns": [false, 1], "turns −": [false, -1], "slides": [true, 1], "slides −": [true, -1]};
const LETTERS = {theta: "θ", d: "d", a: "a", alpha: "α"};
const POSE = ["x", "y", "z", "roll", "pitch", "yaw"];
const state = {table: null, solver: null, q: [], T: I4, solutions: [], chosen: -1, doubt: false, sliders: []};

const limitsOf = i => {
  const {lower, upper, rows} = state.table, far = rows[i].slides ? state.solver.size : Math.PI;
  return [Number.isFinite(lower[i]) ? lower[i] : -far, Number.isFinite(upper[i]) ? upper[i] : far];
};

const withNumbers = preset => ({
  ...structuredClone(preset), lower: preset.lower.map(v => v ?? -Infinity), upper: preset.upper.map(v => v ?? Infinity),
});

// The number as it is typed in the unit chosen, all of its digits but the noise of a change of units.
const typed = (value, kind) => Number.isFinite(value) ? String(parseFloat((value * SCALES[unitOf(kind)]).toPrecision(14))) : "";

function field(value, kind, put, name, empty) {
  const made = element("input", "", {type: "text", value: typed(value, kind), ariaLabel: name, title: typed(value, kind)});
  made.onchange = () => {
    try {
      put(made.value.trim() === "" && empty !== undefined ? empty : typedValue(made.value, kind));
      made.className = made.className.replace("wrong", "");
      get("fault").textContent = "";
    } catch (error) {
      made.className += " wrong";
      get("fault").textContent = `${name}: ${error.message}`;
      return;
    }
    rebuild();
  };
  return made;
}

function showTable() {
  const {rows, standard, lower, upper} = state.table;
  const heads = Object.entries(LETTERS).map(([key, letter]) => element("th", [letter, element("sub", standard || key[0] !== "a" ? "i" : "i−1"), ` [${unitOf(KINDS[key])}]`]));
  const body = rows.map((row, i) => {
    const joint = element("select", Object.keys(KINDS_OF_JOINT).map(name => element("option", name)), {ariaLabel: `joint ${i + 1}`});
    joint.value = Object.keys(KINDS_OF_JOINT).find(name => KINDS_OF_JOINT[name][0] === row.slides && KINDS_OF_JOINT[name][1] === row.sign);
    joint.onchange = () => {
      const slid = row.slides;
      [row.slides, row.sign] = KINDS_OF_JOINT[joint.value];
      if (slid !== row.slides) [lower[i], upper[i]] = [-Infinity, Infinity];
      rebuild();
    };
    const cells = Object.keys(LETTERS).map(key => field(row[key], KINDS[key], v => { row[key] = v; }, `${LETTERS[key]} of row ${i + 1}`));
    const kind = kindOf(row), bounds = [[lower, -Infinity, "lower"], [upper, Infinity, "upper"]].map(([all, none, name]) =>
      Object.assign(field(all[i], kind, v => {
        if (name === "lower" ? v > upper[i] : v < lower[i]) throw new Error("the lower limit would lie above the upper one");
        all[i] = v;
      }, `${name} limit of row ${i + 1}`, none), {className: "limit", placeholder: "none"}));
    return element("tr", [element("th", String(i + 1)), ...[joint, ...cells, ...bounds].map(made => element("td", made))]);
  });
  const head = element("tr", [element("th", "i"), element("th", "joint"), ...heads, element("th", "lower"), element("th", "upper")]);
  get("table").replaceChildren(element("table", [element("thead", head), element("tbody", body)]));
  get("more").disabled = rows.length > 6;
  get("fewer").disabled = rows.length < 3;
}

// The table is another one: another arm, solver and pose.
function rebuild() {
  const {table} = state, names = table.standard ? ["theta", "d", "a", "alpha"] : ["alpha", "a", "theta", "d"];
  state.solver = solverOf(table);
  Object.assign(arm, {first: table.base, tool: table.tool, size: state.solver.size, standard: table.standard,
    rows: table.rows.map(row => ({...row, motions: names.map(name => [name])})),
    offset: table.rows.map(() => 0), gain: table.rows.map((_, i) => table.rows.map((_, j) => i === j ? 1 : 0)),
    shifts: [0, ...table.rows.map(() => 0)]});
  state.q = table.rows.map((_, i) => Math.min(limitsOf(i)[1], Math.max(limitsOf(i)[0], state.q[i] ?? 0)));
  const {name, refused} = state.solver;
  get("solver").textContent = refused ? `No solver here: ${refused}.` : `Solver: ${name}.`;
  get("ends").hidden = [table.base, table.tool].every(T => T.every((v, k) => v === I4[k]));
  get("convention").value = table.standard ? "standard" : "modified";
  showTable();
  buildSliders();
  aim(fk(state.q), true);
  look();
}

// Find all solutions of a pose; the arm goes to the nearest one, or stays where the joints have it.
function aim(T, stays = false) {
  state.T = T;
  const {solver} = state, found = solver.refused ? {found: [], doubt: false} : solver.solve(T, get("limits").checked);
  state.solutions = found.found;
  state.doubt = found.doubt;
  const far = state.solutions.map(s => Math.max(...s.q.map((v, i) => gapOf(v - state.q[i], arm.rows[i].slides))));
  state.chosen = far.indexOf(Math.min(...far));
  if (stays && !(far[state.chosen] < 1e-6)) state.chosen = -1;
  if (!stays && state.chosen >= 0) state.q = [...state.solutions[state.chosen].q];
  show();
}

const gapOf = (gap, slides) => slides ? Math.abs(gap) : Math.abs(Math.atan2(Math.sin(gap), Math.cos(gap)));

function choose_(k) {
  state.chosen = k;
  state.q = [...state.solutions[k].q];
  show();
}

function showSolutions() {
  const {solutions, solver, chosen, doubt} = state, n = solutions.length;
  get("count").textContent = solver.refused ? "No solutions" : n === 0 ? "No solution: out of reach" + (get("limits").checked ? " or beyond the limits" : "") : n === 1 ? "1 solution" : `${n} solutions`;
  get("doubt").textContent = doubt ? "This pose is singular or next to it: what is listed is certified, but there may be more." : "";
  const heads = ["", ...arm.rows.map((row, i) => `q${subscripts(i + 1)} [${unitOf(kindOf(row))}]`), "residual", "free"];
  const body = solutions.map((s, k) => {
    const swatch = element("span", "", {className: "swatch"});
    swatch.style.background = colourOf(k);
    const cells = [element("td", swatch), ...s.q.map((v, i) => cell(v, kindOf(arm.rows[i]))), element("td", s.residual.toExponential(0).replace("-", MINUS)),
      element("td", s.free.map(i => `q${subscripts(i + 1)}`).join(" "))];
    const row = element("tr", cells, {className: k === chosen ? "chosen" : ""});
    row.onclick = () => choose_(k);
    return row;
  });
  get("solutions").replaceChildren(...n ? [element("table", [element("thead", element("tr", heads.map(h => element("th", h)))), element("tbody", body)])] : []);
}

function showPose() {
  const values = [...origin(state.T), ...rpy(state.T)];
  const fields = POSE.map((name, k) => {
    const kind = k < 3 ? "length" : "angle", given = [...values];
    const made = element("input", "", {type: "text", value: typed(rounded(values[k], kind) / SCALES[unitOf(kind)], kind), ariaLabel: name});
    made.onchange = () => {
      try {
        given[k] = typedValue(made.value, kind);
        get("fault").textContent = "";
      } catch (error) {
        made.className = "wrong";
        get("fault").textContent = `${name}: ${error.message}`;
        return;
      }
      const [x, y, z, roll, pitch, yaw] = given;
      aim(product(shiftX(x), [1, 0, 0, 0, 0, 1, 0, y, 0, 0, 1, z, 0, 0, 0, 1], turnZ(yaw), turnY(pitch), turnX(roll)));
    };
    return element("label", [`${name} [${unitOf(kind)}] `, made]);
  });
  get("pose").replaceChildren(element("p", fields.slice(0, 3), {className: "line"}), element("p", fields.slice(3), {className: "line"}));
}

const turnY = t => [Math.cos(t), 0, Math.sin(t), 0, 0, 1, 0, 0, -Math.sin(t), 0, Math.cos(t), 0, 0, 0, 0, 1];

function buildSliders() {
  state.sliders = arm.rows.map((_, i) => {
    const range = element("input", "", {type: "range", step: "any", ariaLabel: `q${i + 1}`}), value = element("output", "");
    const [low, high] = limitsOf(i);
    Object.assign(range, {min: low, max: high});
    range.oninput = () => { state.q[i] = Number(range.value); aim(fk(state.q), true); };
    return {range, value, label: element("label", `q${subscripts(i + 1)}`)};
  });
  get("sliders").replaceChildren(...state.sliders.map(({label, range, value}) => element("div", [label, range, value], {className: "joint"})));
}

function showSliders() {
  state.sliders.forEach(({range, value}, i) => {
    range.value = state.q[i];
    value.textContent = text(state.q[i], kindOf(arm.rows[i]));
  });
}

const draw = () => drawScene(state.solutions, state.chosen, state.q, state.T);

function look() {
  lookAtSolutions(state.solutions, state.q);
  draw();
}

function show() {
  showPose();
  showSolutions();
  showSliders();
  draw();
}

// What was in the picture stays in it when the window changes.
function refit() {
  const size = Math.min(main.clientWidth, main.clientHeight);
  eye.scale *= size / (state.size ?? size);
  state.size = size;
  draw();
}

function start(k) {
  state.table = withNumbers(page.presets[k]);
  state.q = [...page.presets[k].start];
  rebuild();
}

async function begin() {
  document.querySelector("footer").textContent = document.querySelector("meta[name=generator]").content;
  await loadKernels(page.kernels);
  get("presets").replaceChildren(...page.presets.map(preset => element("option", preset.name)));
  get("presets").onchange = () => start(get("presets").selectedIndex);
  get("convention").onchange = () => { state.table.standard = get("convention").value === "standard"; rebuild(); };
  get("units").onchange = () => { showTable(); show(); };
  get("limits").onchange = () => aim(state.T);
  get("more").onclick = () => {
    const {rows, lower, upper} = state.table;
    rows.push({theta: 0, d: 0, a: 0, alpha: 0, slides: false, sign: 1});
    lower.push(-Infinity);
    upper.push(Infinity);
    rebuild();
  };
  get("fewer").onclick = () => { [state.table.rows, state.table.lower, state.table.upper, state.q].forEach(list => list.pop()); rebuild(); };
  get("bare").onclick = () => { Object.assign(state.table, {base: I4, tool: I4}); rebuild(); };
  get("zero").onclick = () => { state.q = arm.rows.map((_, i) => Math.min(limitsOf(i)[1], Math.max(limitsOf(i)[0], 0))); aim(fk(state.q), true); };
  get("random").onclick = () => { state.q = arm.rows.map((_, i) => { const [low, high] = limitsOf(i); return low + Math.random() * (high - low); }); aim(fk(state.q), true); };
  followPointers(canvas, draw);
  canvas.ondblclick = look;
  get("presets").value = "ur5e";
  start(get("presets").selectedIndex);
  new ResizeObserver(refit).observe(main);
  document.body.dataset.ready = "yes";
}

begin();
