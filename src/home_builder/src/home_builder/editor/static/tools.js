"use strict";
// Tools: what clicks, drags and typed numbers do to the plan.

const TOOLS = [
  ["select", "Select", "v"], ["wall", "Wall", "w"], ["door", "Door", "d"], ["window", "Window", "n"],
  ["room", "Room name", "r"], ["place", "Place", "p"], ["start", "Start", "s"],
  ["keep_out", "Keep-out", "k"], ["speed", "Speed zone", "l"],
];
const HINTS = {
  select: "Click to select, Shift: several; drag to move. R turns. Shift+drag on the floor selects an area. " +
    "Drag the floor to pan, turn the wheel to zoom.",
  wall: "Click from corner to corner; type a length and press Enter; Esc ends. Shift: any direction.",
  door: "Click on a wall.", window: "Click on a wall.", room: "Click into a room.",
  place: "Press where the robot stops, drag to turn it: pickup, dropoff and dock have a meaning.",
  start: "Press where the robot starts, drag to turn it.",
  keep_out: "Click the corners; Enter or a double click ends.", speed: "Click the corners; Enter or a double click ends.",
  scale: "Click two points of the template, then type their distance in metres and press Enter.",
  template: "Drag the template.",
};
const NEAR = 12;  // distance to ends and lines of walls [pixels]
const MIN_SIDE = 0.05;  // of furniture that is scaled [m]

let tool = "select", kind = null;
let points = [], typed = "", pointer = [0, 0], drag = null;
const newWall = { thickness: 0.12, height: 2.5 };

function choose(name, furniture = null) {
  [tool, kind, points, typed] = [name, furniture, [], ""];
  if (name !== "select") selection = [];
  $("hint").textContent = furniture ? `Click where the ${furniture} stands.` : HINTS[name];
  for (const button of document.querySelectorAll("[data-tool]")) {
    button.classList.toggle("active", button.dataset.tool === (furniture || name));
  }
  draw();
  showFields();
}

// -- snapping ------------------------------------------------------------------------------------------------

function snapped(point, isFree, walls = plan.walls) {
  const reach = NEAR / view.scale;
  let best = null, distance = reach;
  for (const wall of walls) for (const end of [wall.start, wall.end]) {
    const gap = Math.hypot(end[0] - point[0], end[1] - point[1]);
    if (gap < distance) { best = end; distance = gap; }
  }
  if (best) return [...best];
  let [x, y] = point.map(onGrid);
  const last = points[points.length - 1];
  if (last && tool === "wall" && !isFree) {
    if (Math.abs(point[0] - last[0]) < Math.abs(point[1] - last[1]) * 0.2) x = last[0];
    else if (Math.abs(point[1] - last[1]) < Math.abs(point[0] - last[0]) * 0.2) y = last[1];
  }
  const line = nearestWall([x, y], reach, walls);
  if (line) {
    const on = alongWall(line.wall, line.at);
    // A wall across keeps its direction and ends on the line.
    if (last && x === last[0]) y = on[1]; else if (last && y === last[1]) x = on[0]; else [x, y] = on;
  }
  return [rounded(x), rounded(y)];
}

function nearestWall(point, reach, walls = plan.walls) {
  let best = null;
  walls.forEach((wall, index) => {
    const length = wallLength(wall);
    if (!length) return;
    const u = [(wall.end[0] - wall.start[0]) / length, (wall.end[1] - wall.start[1]) / length];
    const d = [point[0] - wall.start[0], point[1] - wall.start[1]];
    const at = d[0] * u[0] + d[1] * u[1], across = Math.abs(d[1] * u[0] - d[0] * u[1]);
    if (at >= 0 && at <= length && across < reach && (!best || across < best.across)) best = { wall, index, at, across };
  });
  return best;
}

function contains(corners, [x, y]) {
  let isInside = false;
  corners.forEach(([x1, y1], k) => {
    const [x2, y2] = corners[(k + 1) % corners.length];
    if ((y1 > y) !== (y2 > y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)) isInside = !isInside;
  });
  return isInside;
}

// -- clicks ------------------------------------------------------------------------------------------------

function clicked(point, isFree) {
  if (tool === "wall") return addCorner(snapped(point, isFree));
  if (tool === "door" || tool === "window") return addOpening(point);
  if (tool === "keep_out" || tool === "speed") { points.push(snapped(point)); return draw(); }
  if (tool === "scale") { points = [...points, point].slice(-2); return draw(); }
  if (tool === "template") { drag = { template: cloned(plan.template), from: point, before: JSON.stringify(plan) }; return; }
  const [x, y] = point.map(onGrid);
  selection = [];
  if (tool === "start") {
    selection = ["start"];
    turnByDragging("start", () => Object.assign(plan.start, { x, y }));
  } else if (tool === "place") {
    turnByDragging(`places/${plan.places.length}`, () => add("places", { name: "place", x, y, yaw: 0, radius: 0.35 }));
    drag.isNamed = true;
  } else if (tool === "room") {
    const room = judged.rooms.find(each => contains(each.corners, point));
    const named = room ? plan.rooms.findIndex(each => contains(room.corners, [each.x, each.y])) : -1;
    if (named >= 0) { selection = [`rooms/${named}`]; draw(); showFields(); }
    else change(() => add("rooms", { name: "room", x, y }));
    writeName();
  } else {
    change(() => add("furniture", { kind, x, y, yaw: 0, size: [...palette[kind]] }));
  }
}

function turnByDragging(path, edit) {
  const before = JSON.stringify(plan);
  edit();
  drag = { handle: `${path}#turn`, original: cloned(itemOf(path)), before };
  draw();
  showFields();
}

function writeName() {  // the next keys are the name of what was added
  const input = document.querySelector('[data-field="name"]');
  if (input) setTimeout(() => { input.focus(); input.select(); });
}

function addCorner(point) {
  const last = points[points.length - 1];
  if (last && Math.hypot(point[0] - last[0], point[1] - last[1]) < 0.05) return;
  points.push(point);
  typed = "";
  if (!last) return draw();
  selection = [];
  change(() => add("walls", { start: last, end: point, ...newWall }));
  selection = [];
  if (points.length > 2 && Math.hypot(point[0] - points[0][0], point[1] - points[0][1]) < 1e-6) points = [];
  draw();
  showFields();
}

function addOpening(point) {
  const found = nearestWall(point, Math.max(NEAR / view.scale, 0.15));
  if (!found) return status("click on a wall", true);
  const { wall } = found, length = wallLength(wall);
  const width = Math.min(tool === "door" ? 0.9 : 1.2, length);
  const at = Math.min(Math.max(onGrid(found.at), width / 2), length - width / 2);
  const edges = tool === "door" ? { bottom: 0, top: 2 } : { bottom: 0.9, top: 2.1 };
  change(() => {
    wall.openings = [...(wall.openings || []), { kind: tool, at: rounded(at), width: rounded(width), ...edges }];
    selection = [`walls/${found.index}/openings/${wall.openings.length - 1}`];
  });
}

function finish() {
  const number = Number(typed.replace(",", "."));
  if (typed && !(number > 0)) {
    status("type a length above 0 m", true);
  } else if (tool === "wall" && points.length && number > 0) {
    const last = points[points.length - 1], aim = snapped(pointer);
    const length = Math.hypot(aim[0] - last[0], aim[1] - last[1]);
    if (length) addCorner([0, 1].map(k => rounded(last[k] + (aim[k] - last[k]) / length * number)));
  } else if (tool === "scale" && points.length === 2 && number > 0) {
    scaleTemplate(number);
  } else if ((tool === "keep_out" || tool === "speed") && points.length > 2) {
    const zone = { name: tool === "speed" ? "slow" : "keep out", kind: tool, corners: points };
    if (tool === "speed") zone.max_speed = 0.2;
    [points, selection] = [[], []];
    change(() => add("zones", zone));
  } else {
    points = [];
  }
  typed = "";
  draw();
}

function scaleTemplate(distance) {  // the first of the two points stays
  const [a, b] = points, apart = Math.hypot(a[0] - b[0], a[1] - b[1]);
  if (apart < 1e-3) return status("click two different points of the template", true);
  const { template } = plan, factor = distance / apart;
  change(() => Object.assign(template, {
    x: rounded(a[0] - (a[0] - template.x) * factor), y: rounded(a[1] - (a[1] - template.y) * factor), scale: template.scale * factor,
  }));
  choose("select");
}

// -- drags ------------------------------------------------------------------------------------------------

function dragTo(point, isFree) {
  if (drag.handle) return dragHandle(point, isFree);
  const by = [0, 1].map(k => rounded(onGrid(point[k] - drag.from[k])));
  if (drag.template) return Object.assign(plan.template, { x: rounded(drag.template.x + by[0]), y: rounded(drag.template.y + by[1]) });
  drag.paths.forEach((path, k) => {
    if (path.includes("openings")) slideOpening(path, point);
    else move(itemOf(path), ...by, drag.originals[k]);
  });
}

function slideOpening(path, point) {
  const opening = itemOf(path), wall = plan.walls[path.split("/")[1]], length = wallLength(wall) || 1;
  const d = [point[0] - wall.start[0], point[1] - wall.start[1]];
  const at = (d[0] * (wall.end[0] - wall.start[0]) + d[1] * (wall.end[1] - wall.start[1])) / length;
  opening.at = rounded(Math.min(Math.max(onGrid(at), opening.width / 2), length - opening.width / 2));
}

function dragHandle(point, isFree) {
  const [path, handle] = drag.handle.split("#"), item = itemOf(path), number = Number(handle.slice(-1));
  if (handle === "start" || handle === "end") item[handle] = snapped(point, isFree, plan.walls.filter(each => each !== item));
  else if (handle === "turn") turnTo(path, item, point, isFree);
  else if (path.startsWith("zones")) item.corners[number] = snapped(point);
  else scalePiece(item, drag.original, number, isFree ? point : point.map(onGrid));
}

function turnTo(path, item, point, isFree) {
  const reach = Math.hypot(point[0] - item.x, point[1] - item.y);
  if (reach < 0.1) return;  // a click keeps the direction
  const yaw = Math.atan2(point[1] - item.y, point[0] - item.x) - (path.startsWith("furniture") ? Math.PI / 2 : 0);
  item.yaw = rounded(wrapped(isFree ? yaw : Math.round(yaw / TURN) * TURN));
}

function scalePiece(piece, original, number, point) {  // the opposite corner stays
  const fixed = furnitureCorners(original)[(number + 2) % 4];
  const cos = Math.cos(piece.yaw), sin = Math.sin(piece.yaw);
  const d = [point[0] - fixed[0], point[1] - fixed[1]];
  const along = d[0] * cos + d[1] * sin, across = d[1] * cos - d[0] * sin;
  const [sx, sy] = [[-1, -1], [1, -1], [1, 1], [-1, 1]][number];
  const width = Math.max(sx * along, MIN_SIDE), depth = Math.max(sy * across, MIN_SIDE);
  Object.assign(piece, {
    size: [rounded(width), rounded(depth), piece.size[2]],
    x: rounded(fixed[0] + (sx * width * cos - sy * depth * sin) / 2), y: rounded(fixed[1] + (sx * width * sin + sy * depth * cos) / 2),
  });
}

function selectArea([x1, y1], [x2, y2]) {
  const between = (value, a, b) => Math.min(a, b) <= value && value <= Math.max(a, b);
  selection = allPaths().filter(path => {
    const [x, y] = anchorOf(path);
    return between(x, x1, x2) && between(y, y1, y2);
  });
}
