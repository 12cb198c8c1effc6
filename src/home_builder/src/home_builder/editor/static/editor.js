"use strict";
// The editor: undo, autosave, mouse and keys.

const MOST_UNDO = 500, MAX_TEMPLATE = 32 << 20;

let palette = {}, judged = { problems: [], rooms: [] }, version = "";
let done = [], undone = [], saving = null, isStale = false;

const $ = id => document.getElementById(id);

// -- changes ------------------------------------------------------------------------------------------------

function change(edit) {
  const before = JSON.stringify(plan);
  edit();
  changedFrom(before);
}

function changedFrom(before) {
  if (JSON.stringify(plan) === before) return;
  done.push(before);
  if (done.length > MOST_UNDO) done.shift();
  undone = [];
  changed();
}

function changed() {
  draw();
  showFields();
  isStale = true;
  if (!saving) saving = save();
}

function step(from, to) {
  if (!from.length) return;
  to.push(JSON.stringify(plan));
  plan = JSON.parse(from.pop());
  selection = selection.filter(itemOf);
  changed();
}

async function save() {
  while (isStale) {
    isStale = false;
    status("saving ...");
    try {
      judged = await request("PUT", "/plan", JSON.stringify(forFile(plan)), { "If-Match": version });
      version = judged.version;
      status("saved");
    } catch (error) {
      status(error.message, true);
      if (error.isLost) { isStale = true; await new Promise(resolve => setTimeout(resolve, 1000)); }
    }
    draw();
    showJudged();
  }
  saving = null;
}

async function request(method, path, body, headers = {}) {
  let answer;
  try {
    answer = await fetch(path, { method, body, headers });
  } catch (error) {
    throw Object.assign(new Error("not saved: the editor's program has ended; start it again"), { isLost: true });
  }
  const content = answer.headers.get("Content-Type") === "application/json" ? await answer.json() : { error: await answer.text() };
  if (!answer.ok) throw new Error(content.error);
  return content;
}

// -- drawing ------------------------------------------------------------------------------------------------

function draw() {
  measure();
  svg.replaceChildren();
  drawTemplate(plan.template);
  drawGrid();
  drawPlan(plan, judged, selection);
  if (single()) drawHandles(itemOf(single()), single());
  drawProblems(judged.problems);
  drawPreview();
  $("undo").disabled = !done.length;
  $("redo").disabled = !undone.length;
}

let isDrawing = false;

function drawSoon() {  // several moves of the pointer in one frame of the page are drawn once
  if (isDrawing) return;
  isDrawing = true;
  requestAnimationFrame(() => { isDrawing = false; draw(); });
}

function fit() {
  const { template } = plan;
  const all = [
    [plan.start.x, plan.start.y], ...plan.walls.flatMap(wall => [wall.start, wall.end]), ...plan.furniture.map(piece => [piece.x, piece.y]),
    ...(template ? [[template.x, template.y], [template.x + template.width * template.scale, template.y + template.height * template.scale]] : []),
  ];
  const xs = all.map(p => p[0]), ys = all.map(p => p[1]);
  const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
  measure();
  view.x = (low[0] + high[0]) / 2;
  view.y = (low[1] + high[1]) / 2;
  view.scale = Math.min(80, box.width / (high[0] - low[0] + 2), box.height / (high[1] - low[1] + 2));
  draw();
}

// -- mouse and keys ------------------------------------------------------------------------------------------------

svg.addEventListener("pointerdown", event => {
  event.preventDefault();  // it would take the focus from a name that is to be written
  svg.focus();
  svg.setPointerCapture(event.pointerId);
  pointer = toPlan(event.clientX, event.clientY);
  const { item, handle } = event.target.dataset;
  if (event.button !== 0) drag = { pan: [event.clientX, event.clientY] };
  else if (tool !== "select") clicked(pointer, event.shiftKey);
  else if (handle) drag = { handle, original: cloned(itemOf(handle.split("#")[0])), before: JSON.stringify(plan) };
  else if (item) press(item, event.shiftKey);
  else if (event.shiftKey) drag = { area: pointer };
  else { drag = { pan: [event.clientX, event.clientY] }; selection = []; draw(); showFields(); }
});

function press(item, isAdded) {
  if (isAdded) selection = selection.includes(item) ? selection.filter(each => each !== item) : [...selection, item];
  else if (!selection.includes(item)) selection = [item];
  drag = { paths: selection, from: pointer, originals: selection.map(path => cloned(itemOf(path))), before: JSON.stringify(plan) };
  draw();
  showFields();
}

svg.addEventListener("pointermove", event => {
  pointer = toPlan(event.clientX, event.clientY);
  if (drag && drag.pan) {
    view.x -= (event.clientX - drag.pan[0]) / view.scale;
    view.y += (event.clientY - drag.pan[1]) / view.scale;
    drag.pan = [event.clientX, event.clientY];
  } else if (drag && drag.before) {
    dragTo(pointer, event.shiftKey);
  } else if (!drag && !points.length) {
    return;
  }
  drawSoon();
});

svg.addEventListener("pointerup", () => {
  const ended = drag;
  drag = null;
  if (ended && ended.before) changedFrom(ended.before);
  if (ended && ended.isNamed) writeName();
  if (ended && ended.area) { selectArea(ended.area, pointer); draw(); showFields(); }
});

svg.addEventListener("dblclick", finish);

svg.addEventListener("wheel", event => {
  event.preventDefault();
  const before = toPlan(event.clientX, event.clientY);
  view.scale = Math.min(400, Math.max(4, view.scale * Math.exp(-event.deltaY / 500)));
  const after = toPlan(event.clientX, event.clientY);
  view.x += before[0] - after[0];
  view.y += before[1] - after[1];
  drawSoon();
}, { passive: false });

const COMMANDS = {
  z: event => event.shiftKey ? step(undone, done) : step(done, undone), y: () => step(undone, done), d: duplicate,
  c: copySelection, x: () => { copySelection(); removeSelection(); }, v: () => paste(clipboard, pointer),
  a: () => { selection = allPaths(); draw(); showFields(); },
};

document.addEventListener("keydown", event => {
  if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName)) return;
  const key = event.key.toLowerCase();
  if (event.ctrlKey || event.metaKey) {
    if (COMMANDS[key]) { event.preventDefault(); COMMANDS[key](event); }
    return;
  }
  if (points.length && /^[0-9.,]$/.test(key)) { typed += key; return draw(); }
  if (key === "backspace" && typed) { typed = typed.slice(0, -1); return draw(); }
  if (key === "enter") return finish();
  if (key === "escape") { selection = []; return choose("select"); }
  if ((key === "delete" || key === "backspace") && selection.length) return removeSelection();
  if (key === "0") return fit();
  if (key === "r" && selection.some(path => itemOf(path).yaw !== undefined)) return turnSelection(event.shiftKey ? -TURN : TURN);
  const wanted = TOOLS.find(each => each[2] === key);
  if (wanted) choose(wanted[0]);
});

// -- start ------------------------------------------------------------------------------------------------

function button(parent, text, name, onClick) {
  const made = document.createElement("button");
  made.textContent = text;
  if (name) made.dataset.tool = name;
  made.addEventListener("click", onClick);
  parent.appendChild(made);
}

async function begin() {
  const state = await request("GET", "/plan");
  plan = fromFile(state.plan);
  ({ palette, version } = state);
  judged = state;
  document.title = `${plan.name}: home editor`;
  for (const [name, title, key] of TOOLS) button($("tools"), title, name, () => choose(name), key);
  for (const name of Object.keys(palette)) button($("palette"), name, name, () => choose("furniture", name));
  const actions = {
    undo: () => step(done, undone), redo: () => step(undone, done), copy: duplicate, delete: removeSelection, fit,
    build: () => act("/build", "building ..."), try: () => act("/try", "building, then running the mission ..."),
    drive: () => act("/drive", "building, then starting the robot ..."), scale: withTemplate(() => choose("scale")),
    move: withTemplate(() => choose("template")), trace: withTemplate(trace),
    clear: withTemplate(() => change(() => { delete plan.template; })),
  };
  for (const [name, action] of Object.entries(actions)) $(name).addEventListener("click", action);
  $("template").addEventListener("change", event => loadTemplate(event.target.files[0]));
  new ResizeObserver(draw).observe(svg);  // the header grows with long messages
  window.addEventListener("beforeunload", event => { if (isStale || saving) event.preventDefault(); });
  choose("select");
  showJudged();
  if (plan.walls.length || plan.template) fit();
  status(`saved in ${state.folder}`);
}

begin().catch(error => status(error.message, true));
