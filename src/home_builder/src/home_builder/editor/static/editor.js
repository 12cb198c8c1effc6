"use strict";
// The editor: tools, properties, undo, autosave. The plan has the form of plan.yaml.

const TOOLS = [
  ["select", "Select", "v"], ["wall", "Wall", "w"], ["door", "Door", "d"], ["window", "Window", "n"],
  ["room", "Room name", "r"], ["place", "Place", "p"], ["start", "Start", "s"],
  ["keep_out", "Keep-out", "k"], ["speed", "Speed zone", "l"],
];
const HINTS = {
  select: "Click to select, drag to move. R turns furniture. Drag the floor to pan, turn the wheel to zoom.",
  wall: "Click from corner to corner; type a length and press Enter; Esc ends. Shift: any direction.",
  door: "Click on a wall.", window: "Click on a wall.", room: "Click into a room.",
  place: "Click where the robot stops: pickup, dropoff and dock have a meaning.", start: "Click where the robot starts.",
  keep_out: "Click the corners; Enter or a double click ends.", speed: "Click the corners; Enter or a double click ends.",
  scale: "Click two points of the template, then type their distance in metres and press Enter.",
};
const SNAP = 0.05, NEAR = 12;  // grid [m], distance to ends and lines of walls [pixels]
const MOST_UNDO = 500;

let plan, palette = {}, judged = { problems: [], rooms: [] };
let tool = "select", kind = null, chosen = null, template = null;
let points = [], typed = "", pointer = [0, 0], drag = null;
let done = [], undone = [], saving = null, isStale = false;

const $ = id => document.getElementById(id);
const rounded = value => Math.round(value * 1e4) / 1e4;

// -- state ------------------------------------------------------------------------------------------------

function change(edit) {
  const before = JSON.stringify(plan);
  edit();
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
  if (chosen && !itemOf(chosen)) chosen = null;
  changed();
}

async function save() {
  while (isStale) {
    isStale = false;
    status("saving ...");
    try {
      judged = await request("PUT", "/plan", JSON.stringify(plan));
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

async function request(method, path, body) {
  let answer;
  try {
    answer = await fetch(path, { method, body });
  } catch (error) {
    throw Object.assign(new Error("not saved: the editor's program has ended; start it again"), { isLost: true });
  }
  const content = answer.headers.get("Content-Type") === "application/json" ? await answer.json() : { error: await answer.text() };
  if (!answer.ok) throw new Error(content.error);
  return content;
}

function status(text, isError = false) {
  $("saved").textContent = text;
  $("saved").className = isError ? "error" : "";
}

// -- items: "walls/0", "walls/0/openings/1", "furniture/2", "start" ----------------------------------------------

function itemOf(path) {
  return path.split("/").reduce((part, key) => part && part[key], plan);
}

function removeItem(path) {
  const keys = path.split("/"), index = keys.pop();
  if (path === "start") return;
  change(() => keys.reduce((part, key) => part[key], plan).splice(Number(index), 1));
}

function move(item, dx, dy, original) {
  const at = ([x, y]) => [rounded(x + dx), rounded(y + dy)];
  if (Array.isArray(item)) [item[0], item[1]] = at(original);
  else if (item.start) Object.assign(item, { start: at(original.start), end: at(original.end) });
  else if (item.corners && item.x === undefined) item.corners = original.corners.map(at);
  else Object.assign(item, { x: rounded(original.x + dx), y: rounded(original.y + dy) });
}

function duplicate() {
  if (!chosen || chosen === "start" || chosen.includes("openings")) return;
  const [list] = chosen.split("/"), copy = JSON.parse(JSON.stringify(itemOf(chosen)));
  if (copy.name) copy.name = freeName(copy.name);
  move(copy, 0.5, -0.5, JSON.parse(JSON.stringify(copy)));
  change(() => { plan[list].push(copy); chosen = `${list}/${plan[list].length - 1}`; });
}

function freeName(name) {
  const taken = new Set([...plan.rooms, ...plan.places, ...plan.zones, ...plan.furniture].map(each => each.name));
  const stem = name.replace(/ \d+$/, "");
  let free = name;
  for (let number = 2; taken.has(free); number++) free = `${stem} ${number}`;
  return free;
}

// -- snapping ------------------------------------------------------------------------------------------------

function snapped(point, isFree) {
  const reach = NEAR / view.scale;
  let best = null, distance = reach;
  for (const wall of plan.walls) for (const end of [wall.start, wall.end]) {
    const gap = Math.hypot(end[0] - point[0], end[1] - point[1]);
    if (gap < distance) { best = end; distance = gap; }
  }
  if (best) return [...best];
  let [x, y] = point.map(value => Math.round(value / SNAP) * SNAP);
  const last = points[points.length - 1];
  if (last && tool === "wall" && !isFree) {
    if (Math.abs(point[0] - last[0]) < Math.abs(point[1] - last[1]) * 0.2) x = last[0];
    else if (Math.abs(point[1] - last[1]) < Math.abs(point[0] - last[0]) * 0.2) y = last[1];
  }
  const line = nearestWall([x, y], reach);
  if (line) {
    const on = alongWall(plan.walls[line.index], line.at);
    // A wall across keeps its direction and ends on the line.
    if (last && x === last[0]) y = on[1]; else if (last && y === last[1]) x = on[0]; else [x, y] = on;
  }
  return [rounded(x), rounded(y)];
}

function nearestWall(point, reach) {
  let best = null;
  plan.walls.forEach((wall, index) => {
    const length = wallLength(wall);
    if (!length) return;
    const u = [(wall.end[0] - wall.start[0]) / length, (wall.end[1] - wall.start[1]) / length];
    const d = [point[0] - wall.start[0], point[1] - wall.start[1]];
    const at = d[0] * u[0] + d[1] * u[1], across = Math.abs(d[1] * u[0] - d[0] * u[1]);
    if (at >= 0 && at <= length && across < reach && (!best || across < best.across)) best = { index, at, across };
  });
  return best;
}

// -- tools ------------------------------------------------------------------------------------------------

function choose(name, furniture = null) {
  [tool, kind, points, typed] = [name, furniture, [], ""];
  $("hint").textContent = furniture ? `Click where the ${furniture} stands.` : HINTS[name];
  for (const button of document.querySelectorAll("[data-tool]")) {
    button.classList.toggle("active", button.dataset.tool === (furniture || name));
  }
  draw();
}

function clicked(point, isFree) {
  if (tool === "wall") return addCorner(snapped(point, isFree));
  if (tool === "door" || tool === "window") return addOpening(point);
  if (tool === "keep_out" || tool === "speed") { points.push(snapped(point)); return draw(); }
  if (tool === "scale") { points.push(point); return draw(); }
  const [x, y] = point.map(value => rounded(Math.round(value / SNAP) * SNAP));
  change(() => {
    if (tool === "start") { plan.start = [x, y]; chosen = "start"; }
    if (tool === "furniture") add("furniture", { kind, x, y, yaw: 0, size: [...palette[kind]] });
    if (tool === "room") add("rooms", { name: freeName("room"), x, y });
    if (tool === "place") add("places", { name: freeName("place"), x, y, yaw: 0, radius: 0.35 });
  });
}

function add(list, item) {
  plan[list].push(item);
  chosen = `${list}/${plan[list].length - 1}`;
}

function addCorner(point) {
  const last = points[points.length - 1];
  if (last && Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.05) return;
  points.push(point);
  typed = "";
  if (!last) return draw();
  change(() => add("walls", { start: last, end: point, thickness: 0.12, height: 2.5 }));
  if (points.length > 2 && Math.hypot(point[0] - points[0][0], point[1] - points[0][1]) < 1e-6) points = [];
}

function addOpening(point) {
  const found = nearestWall(point, Math.max(NEAR / view.scale, 0.15));
  if (!found) return status("click on a wall", true);
  const wall = plan.walls[found.index], length = wallLength(wall);
  const width = Math.min(tool === "door" ? 0.9 : 1.2, length);
  const at = Math.min(Math.max(Math.round(found.at / SNAP) * SNAP, width / 2), length - width / 2);
  const edges = tool === "door" ? { bottom: 0, top: 2 } : { bottom: 0.9, top: 2.1 };
  change(() => {
    wall.openings = [...(wall.openings || []), { kind: tool, at: rounded(at), width: rounded(width), ...edges }];
    chosen = `walls/${found.index}/openings/${wall.openings.length - 1}`;
  });
}

function finish() {
  const number = Number(typed.replace(",", "."));
  if (tool === "wall" && points.length && number > 0) {
    const last = points[points.length - 1], aim = snapped(pointer);
    const length = Math.hypot(aim[0] - last[0], aim[1] - last[1]);
    if (length) addCorner([0, 1].map(k => rounded(last[k] + (aim[k] - last[k]) / length * number)));
  } else if (tool === "scale" && points.length === 2 && number > 0) {
    const [a, b] = points, pixels = Math.hypot(a[0] - b[0], a[1] - b[1]) / template.scale;
    template.scale = number / pixels;
    choose("select");
  } else if ((tool === "keep_out" || tool === "speed") && points.length > 2) {
    const zone = { name: freeName(tool === "speed" ? "slow" : "keep out"), kind: tool, corners: points };
    if (tool === "speed") zone.max_speed = 0.2;
    points = [];
    change(() => add("zones", zone));
  } else {
    points = [];
  }
  typed = "";
  draw();
}

// -- drawing and panels ------------------------------------------------------------------------------------------------

function draw() {
  measure();
  svg.replaceChildren();
  drawTemplate(template);
  drawGrid();
  drawPlan(plan, judged, chosen);
  if (chosen && /^walls\/\d+$/.test(chosen)) drawHandles(itemOf(chosen), chosen);
  drawProblems(judged.problems);
  drawPreview();
  $("undo").disabled = !done.length;
  $("redo").disabled = !undone.length;
}

function drawPreview() {
  if (!points.length) return;
  const aim = tool === "scale" ? pointer : snapped(pointer, drag && drag.isFree);
  if (tool === "wall") {
    const last = points[points.length - 1];
    const wall = { start: last, end: aim, thickness: 0.12 };
    polygon(stretch(wall, 0, wallLength(wall)), "preview");
    label(typed ? `${typed} m` : `${wallLength(wall).toFixed(2)} m`, (last[0] + aim[0]) / 2, (last[1] + aim[1]) / 2 + 0.15);
  } else {
    polygon(points.length < 2 ? [...points, aim] : points, "preview");
    if (typed) label(`${typed} m`, ...points[points.length - 1]);
  }
}

function showFields() {
  const item = chosen && itemOf(chosen), fields = $("fields");
  fields.replaceChildren();
  $("chosen").textContent = chosen ? chosen.split("/").slice(0, 1)[0].replace(/s$/, "") : "Home";
  if (!item) return field("name", plan.name, value => { plan.name = value || "home"; });
  if (Array.isArray(item)) return ["x", "y"].forEach((name, k) => field(name, item[k], value => { item[k] = value; }));
  if (item.start) field("length", rounded(wallLength(item)), value => { if (value > 0) item.end = alongWall(item, value).map(rounded); });
  for (const [name, value] of Object.entries(item)) {
    if (name === "yaw") field("yaw, degrees", rounded(value * 180 / Math.PI), degrees => { item.yaw = rounded(degrees * Math.PI / 180); });
    else if (name === "size") ["width", "depth", "height"].forEach((each, k) => field(each, value[k], side => { if (side > 0) item.size[k] = side; }));
    else if (typeof value === "number" || name === "name") field(name, value, given => { item[name] = given; });
  }
  if (item.kind && item.size && item.name === undefined) field("name", "", value => { if (value) item.name = value; });
}

function field(name, value, set) {
  const row = document.createElement("label"), input = document.createElement("input");
  row.textContent = name;
  input.value = value;
  input.dataset.field = name;
  input.addEventListener("change", () => {
    const given = typeof value === "number" ? Number(input.value.replace(",", ".")) : input.value.trim();
    if (given === "" && value !== "" || Number.isNaN(given)) { input.value = value; return; }
    change(() => set(given));
  });
  row.appendChild(input);
  $("fields").appendChild(row);
}

function showJudged() {
  $("problems").replaceChildren(...judged.problems.map(problem => {
    const line = document.createElement("li");
    line.textContent = problem.text;
    line.className = problem.is_error ? "error" : "";
    line.addEventListener("click", () => { Object.assign(view, { x: problem.x, y: problem.y }); draw(); });
    return line;
  }));
  $("rooms").replaceChildren(...judged.rooms.map(room => {
    const line = document.createElement("li");
    line.textContent = `${room.name}: ${room.area.toFixed(1)} m²`;
    return line;
  }));
}

function fit() {
  const all = [plan.start, ...plan.walls.flatMap(wall => [wall.start, wall.end]), ...plan.furniture.map(piece => [piece.x, piece.y])];
  const xs = all.map(p => p[0]), ys = all.map(p => p[1]);
  const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
  measure();
  view.x = (low[0] + high[0]) / 2;
  view.y = (low[1] + high[1]) / 2;
  view.scale = Math.min(80, box.width / (high[0] - low[0] + 2), box.height / (high[1] - low[1] + 2));
  draw();
}

async function act(path, text) {
  $("output").textContent = text;
  while (saving) await saving;
  try {
    const answer = await request("POST", path);
    $("output").textContent = answer.text || ["built", ...(answer.remarks || [])].join("\n");
  } catch (error) {
    $("output").textContent = error.message;
  }
}

// -- mouse and keys ------------------------------------------------------------------------------------------------

svg.addEventListener("pointerdown", event => {
  svg.focus();
  svg.setPointerCapture(event.pointerId);
  const point = toPlan(event.clientX, event.clientY);
  pointer = point;
  const item = event.target.dataset.item;
  if (tool === "select" && event.button === 0 && item) {
    chosen = item.replace(/\/(start|end)$/, "");
    drag = { item, from: point, original: JSON.parse(JSON.stringify(itemOf(item))), before: JSON.stringify(plan) };
    draw();
    showFields();
  } else if (tool === "select" || event.button !== 0) {
    drag = { pan: [event.clientX, event.clientY] };
    if (tool === "select") { chosen = null; draw(); showFields(); }
  } else {
    clicked(point, event.shiftKey);
  }
});

svg.addEventListener("pointermove", event => {
  pointer = toPlan(event.clientX, event.clientY);
  if (drag && drag.pan) {
    view.x -= (event.clientX - drag.pan[0]) / view.scale;
    view.y += (event.clientY - drag.pan[1]) / view.scale;
    drag.pan = [event.clientX, event.clientY];
    draw();
  } else if (drag) {
    dragTo(pointer);
    draw();
  } else if (points.length) {
    draw();
  }
});

function dragTo(point) {
  const item = itemOf(drag.item);
  const by = [0, 1].map(k => Math.round((point[k] - drag.from[k]) / SNAP) * SNAP);
  if (/\/(start|end)$/.test(drag.item)) {
    const [list, index, end] = drag.item.split("/");
    const wall = plan[list][index], others = plan.walls;
    plan.walls = others.filter(each => each !== wall);
    const target = snapped(point);
    plan.walls = others;
    wall[end] = target;
  } else if (drag.item.includes("openings")) {
    const wall = plan.walls[drag.item.split("/")[1]], length = wallLength(wall) || 1;
    const d = [point[0] - wall.start[0], point[1] - wall.start[1]];
    const at = (d[0] * (wall.end[0] - wall.start[0]) + d[1] * (wall.end[1] - wall.start[1])) / length;
    item.at = rounded(Math.min(Math.max(Math.round(at / SNAP) * SNAP, item.width / 2), length - item.width / 2));
  } else {
    move(item, by[0], by[1], drag.original);
  }
}

svg.addEventListener("pointerup", () => {
  if (drag && drag.before && JSON.stringify(plan) !== drag.before) {
    done.push(drag.before);
    undone = [];
    changed();
  }
  drag = null;
});

svg.addEventListener("dblclick", finish);

svg.addEventListener("wheel", event => {
  event.preventDefault();
  const before = toPlan(event.clientX, event.clientY);
  view.scale = Math.min(400, Math.max(4, view.scale * Math.exp(-event.deltaY / 500)));
  const after = toPlan(event.clientX, event.clientY);
  view.x += before[0] - after[0];
  view.y += before[1] - after[1];
  draw();
}, { passive: false });

document.addEventListener("keydown", event => {
  if (["INPUT", "SELECT", "TEXTAREA"].includes(event.target.tagName)) return;
  const key = event.key.toLowerCase(), command = event.ctrlKey || event.metaKey;
  if (command && key === "z") { event.preventDefault(); return event.shiftKey ? step(undone, done) : step(done, undone); }
  if (command && key === "y") { event.preventDefault(); return step(undone, done); }
  if (command && (key === "d" || key === "v")) { event.preventDefault(); return duplicate(); }
  if (command) return;
  if (points.length && /^[0-9.,]$/.test(key)) { typed += key; return draw(); }
  if (key === "backspace" && typed) { typed = typed.slice(0, -1); return draw(); }
  if (key === "enter") return finish();
  if (key === "escape") { points = []; typed = ""; return choose("select"); }
  if ((key === "delete" || key === "backspace") && chosen) { removeItem(chosen); chosen = null; draw(); return showFields(); }
  if (key === "0") return fit();
  const item = chosen && itemOf(chosen);
  if (key === "r" && item && item.yaw !== undefined) {
    return change(() => { item.yaw = rounded(item.yaw + (event.shiftKey ? -1 : 1) * Math.PI / 12); });
  }
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

function loadTemplate(file) {
  const reader = new FileReader();
  reader.onload = () => {
    const image = new Image();
    image.onload = () => {
      template = { data: reader.result, width: image.naturalWidth, height: image.naturalHeight, x: 0, y: 0, scale: 10 / image.naturalWidth };
      draw();
    };
    image.onerror = () => status(`${file.name} is no picture`, true);
    image.src = reader.result;
  };
  reader.readAsDataURL(file);
}

async function begin() {
  const state = await request("GET", "/plan");
  plan = state.plan;
  palette = state.palette;
  judged = state;
  document.title = `${plan.name}: home editor`;
  for (const [name, title, key] of TOOLS) button($("tools"), title, name, () => choose(name), key);
  for (const name of Object.keys(palette)) button($("palette"), name, name, () => choose("furniture", name));
  $("undo").addEventListener("click", () => step(done, undone));
  $("redo").addEventListener("click", () => step(undone, done));
  $("copy").addEventListener("click", duplicate);
  $("delete").addEventListener("click", () => { if (chosen) { removeItem(chosen); chosen = null; draw(); showFields(); } });
  $("fit").addEventListener("click", fit);
  $("build").addEventListener("click", () => act("/build", "building ..."));
  $("try").addEventListener("click", () => act("/try", "building, then running the mission ..."));
  $("template").addEventListener("change", event => { if (event.target.files[0]) loadTemplate(event.target.files[0]); });
  $("scale").addEventListener("click", () => { if (template) choose("scale"); else status("choose a picture first", true); });
  window.addEventListener("resize", draw);
  window.addEventListener("beforeunload", event => { if (isStale || saving) event.preventDefault(); });
  choose("select");
  showFields();
  showJudged();
  if (plan.walls.length) fit();
  status(`saved in ${state.folder}`);
}

begin().catch(error => status(error.message, true));
