// The panel: sliders, the tip's pose, the table, and each row motion by motion.

const get = id => document.getElementById(id);
const state = {q: [...arm.start], row: 0, step: 0};
const sliders = [];
const FAR = "Its axes are nearly parallel and a frame stands far away: the picture has it on the arm, moved along z.";

function buildSliders() {
  arm.joints.forEach((joint, k) => {
    const [range, field] = ["range", "number"].map(type => Object.assign(document.createElement("input"), {type, step: "any"}));
    range.setAttribute("aria-label", joint.name);
    range.oninput = () => moveTo(k, range.value);
    field.onchange = () => moveTo(k, field.value);
    sliders.push({range, field, label: element("label", "")});
    get("sliders").append(element("div", [sliders[k].label, range, field], {className: "joint"}));
  });
}

// Bring joint k to a value in the unit chosen, within its limits.
function moveTo(k, typed) {
  const {low, high} = arm.joints[k], value = parseFloat(typed) / SCALES[unitOf(kindOf(arm.joints[k]))];
  if (Number.isFinite(value)) state.q[k] = Math.min(high, Math.max(low, value));
  show();
}

function showSliders() {
  sliders.forEach(({range, field, label}, k) => {
    const joint = arm.joints[k], kind = kindOf(joint), scale = SCALES[unitOf(kind)];
    label.textContent = `${joint.name} [${unitOf(kind)}]`;
    Object.assign(range, {min: joint.low * scale, max: joint.high * scale, value: state.q[k] * scale});
    range.title = field.title = `${text(joint.low, kind)} to ${text(joint.high, kind)}`;
    field.value = rounded(state.q[k], kind);
  });
}

function showPose() {
  const T = fk(state.q), rows = [["xyz", "length", origin(T)], ["rpy", "angle", rpy(T)], ["quat. xyzw", "", quaternion(T)]];
  const body = rows.map(([name, kind, values]) => {
    const head = kind ? `${name} [${unitOf(kind)}]` : name;
    return element("tr", [element("th", head), ...values.map(v => cell(v, kind, kind ? undefined : 6))]);
  });
  get("pose").replaceChildren(element("table", element("tbody", body)), matrix(T));
}

function showTable() {
  const sign = {theta: "θ", d: "d", a: "a", alpha: "α"}, keys = Object.keys(sign);
  const heads = keys.map(key => {
    const head = element("th", [sign[key], element("sub", arm.standard || key[0] !== "a" ? "i" : "i−1"), ` [${unitOf(KINDS[key])}]`]);
    head.style.color = arm.colours[key];
    return head;
  });
  const rows = arm.rows.map((row, k) => {
    const made = element("tr", [element("td", String(k + 1)), ...keys.map(key => tableCell(row, key))]);
    made.className = `joint-row ${k + 1 === state.row ? "chosen" : ""}`;
    made.onclick = () => lesson(k + 1, row.motions.length);
    return made;
  });
  const head = element("thead", element("tr", [element("th", "i"), ...heads]));
  get("table").replaceChildren(element("div", element("table", [head, element("tbody", rows)]), {className: "scroll"}));
}

// What the joint moves is shown as its variable.
function tableCell(row, key) {
  const moved = key === (row.slides ? "d" : "theta"), value = rounded(row[key] + (moved ? row.constant : 0), KINDS[key]);
  const offset = value ? ` ${value < 0 ? MINUS : "+"} ${typeset(Math.abs(value))}` : "";
  const made = cell(row[key], KINDS[key], undefined, moved ? row.variable + offset : undefined);
  made.style.color = arm.colours[key];
  return made;
}

// Where the row in hand leads, motion by motion: values, and poses in the base.
function courseOf(placed) {
  const row = arm.rows[state.row - 1], q = chain(state.q)[state.row - 1], T = motionsOf(row, q);
  const poses = [placed[state.row - 1]], product = [I4];
  T.forEach((M, k) => { poses.push(mul(poses[k], M)); product.push(mul(product[k], M)); });
  return {poses, product, values: row.motions.map(([key]) => key === "step" ? 0 : valueOf(row, key, q))};
}

function lesson(row, step) {
  Object.assign(state, {row, step});
  show();
}

function previous() {
  if (state.step) lesson(state.row, state.step - 1);
  else if (state.row > 1) lesson(state.row - 1, arm.rows[state.row - 2].motions.length);
}

function next() {
  const last = state.row ? arm.rows[state.row - 1].motions.length : 0;
  if (state.row && state.step < last) lesson(state.row, state.step + 1);
  else if (state.row < arm.rows.length) lesson(state.row + 1, 0);
}

function showLesson(course) {
  get("previous").disabled = state.row < 2 && !state.step;
  get("next").disabled = state.row === arm.rows.length && state.step === arm.rows[state.row - 1].motions.length;
  get("whole").disabled = !state.row;
  const prompt = "Choose a row of the table, or Next, to see how its motions lead from one frame to the next.";
  get("lesson").replaceChildren(...course ? lessonLines(course) : [element("p", prompt)]);
}

function lessonLines({product, values}) {
  const [i, k] = [state.row, state.step], {motions} = arm.rows[i - 1], pair = element("sub", `${i - 1},${i}`);
  let said = `Row ${i}: it starts in frame ${i - 1}.`;
  if (k) {
    const [key, words] = motions[k - 1], value = key === "step" ? "" : ` = ${text(values[k - 1], KINDS[key])}`;
    said = `Row ${i}, motion ${k} of ${motions.length}: ${words}${value}.` + (k === motions.length ? ` Frame ${i} is reached.` : "");
  }
  const factors = motions.flatMap(([, , factor], j) => [j ? " · " : " = ", element("span", factor, {className: j < k ? "done" : "ahead"})]);
  const far = arm.shifts[i - 1] || arm.shifts[i] ? [element("p", FAR)] : [];
  const so = k === motions.length ? ["T", pair.cloneNode(true), " ="] : ["so far ="];
  return [element("p", said), ...far, element("p", ["T", pair, ...factors]), element("p", so), matrix(product[k])];
}

function showScene(placed, course) {
  const ratio = window.devicePixelRatio || 1, frames_ = get("frames").checked;
  for (const canvas of [bodies, marks]) {
    const size = [main.clientWidth * ratio, main.clientHeight * ratio].map(Math.round);
    if (canvas.width !== size[0] || canvas.height !== size[1]) [canvas.width, canvas.height] = size;
  }
  drawBodies(placed, course ? 0.25 : frames_ ? 0.45 : 1);
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, main.clientWidth, main.clientHeight);
  const far = course && (arm.shifts[state.row - 1] || arm.shifts[state.row]);
  if (far) drawFrames([placed[state.row - 1], placed[state.row]], state.row - 1);
  else if (course) drawRow(state.row, state.step, course.poses, course.values);
  else if (frames_) drawFrames(placed, 0);
}

function draw() {
  const placed = frames(state.q);
  showScene(placed, state.row ? courseOf(placed) : null);
}

function show() {
  showSliders();
  showPose();
  showTable();
  showLesson(state.row ? courseOf(frames(state.q)) : null);
  draw();
}

// What was in the picture stays in it when the window changes.
function refit() {
  const size = Math.min(main.clientWidth, main.clientHeight);
  eye.scale *= size / (state.size ?? size);
  state.size = size;
  draw();
}

function savePicture() {
  draw();
  const picture = Object.assign(document.createElement("canvas"), {width: marks.width, height: marks.height});
  const both = picture.getContext("2d");
  both.fillStyle = "#fff";
  both.fillRect(0, 0, picture.width, picture.height);
  if (gl) both.drawImage(bodies, 0, 0);
  both.drawImage(marks, 0, 0);
  element("a", "", {href: picture.toDataURL("image/png"), download: `${arm.name.replace(/[^\w-]+/g, "_")}.png`}).click();
}

function begin() {
  const [heading, ...about] = arm.title.split("\n");
  document.querySelector("h1").textContent = heading;
  get("about").textContent = about.join("\n");
  get("tip").textContent = `${arm.tip} in ${arm.base}`;
  document.querySelector("footer").textContent = (arm.source ? `${arm.source}. ` : "") + document.querySelector("meta[name=generator]").content;
  buildSliders();
  get("units").onchange = get("frames").onchange = show;
  get("zero").onclick = () => { state.q = arm.joints.map(j => Math.min(j.high, Math.max(j.low, 0))); show(); };
  get("random").onclick = () => { state.q = arm.joints.map(j => j.low + Math.random() * (j.high - j.low)); show(); };
  Object.assign(get("previous"), {onclick: previous});
  Object.assign(get("next"), {onclick: next});
  get("whole").onclick = () => lesson(0, 0);
  get("picture").onclick = savePicture;
  onkeydown = event => { if (!/^(INPUT|SELECT)$/.test(event.target.tagName)) ({ArrowLeft: previous, ArrowRight: next})[event.key]?.(); };
  followPointers(marks, draw);
  marks.ondblclick = () => { lookAtAll(state.q); draw(); };
  new ResizeObserver(refit).observe(main);
  lookAtAll(state.q);
  show();
}

begin();
