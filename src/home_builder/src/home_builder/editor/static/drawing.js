"use strict";
// The drawing: from the plan to SVG, and from points of the page to points of the plan [m].

const SVG = "http://www.w3.org/2000/svg";
const svg = document.getElementById("drawing");
const view = { x: 4, y: 3, scale: 60 };  // middle of the drawing [m], pixels per metre
let box = svg.getBoundingClientRect();  // measured once a drawing, as each measurement lays out the page

function measure() {
  box = svg.getBoundingClientRect();
}

function toPage(x, y) {
  return [box.width / 2 + (x - view.x) * view.scale, box.height / 2 - (y - view.y) * view.scale];
}

function toPlan(pageX, pageY) {
  return [
    view.x + (pageX - box.left - box.width / 2) / view.scale,
    view.y - (pageY - box.top - box.height / 2) / view.scale,
  ];
}

function made(kind, attributes, parent = svg) {
  const element = document.createElementNS(SVG, kind);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  parent.appendChild(element);
  return element;
}

function polygon(points, kind, item) {
  const element = made("polygon", { points: points.map(p => toPage(...p).join(",")).join(" "), class: kind });
  if (item) element.dataset.item = item;
  return element;
}

function label(text, x, y) {
  const [left, top] = toPage(x, y);
  made("text", { x: left, y: top, "text-anchor": "middle" }).textContent = text;
}

function wallLength(wall) {
  return Math.hypot(wall.end[0] - wall.start[0], wall.end[1] - wall.start[1]);
}

function alongWall(wall, distance, across = 0) {
  const length = wallLength(wall) || 1;
  const u = [(wall.end[0] - wall.start[0]) / length, (wall.end[1] - wall.start[1]) / length];
  return [wall.start[0] + u[0] * distance - u[1] * across, wall.start[1] + u[1] * distance + u[0] * across];
}

function stretch(wall, first, last, thickness = wall.thickness) {
  const half = thickness / 2;
  return [alongWall(wall, first, half), alongWall(wall, first, -half), alongWall(wall, last, -half), alongWall(wall, last, half)];
}

function furnitureCorners(piece) {
  const [w, d] = piece.size;
  const corners = piece.corners || [[-w / 2, -d / 2], [w / 2, -d / 2], [w / 2, d / 2], [-w / 2, d / 2]];
  const cos = Math.cos(piece.yaw), sin = Math.sin(piece.yaw);
  return corners.map(([x, y]) => [piece.x + x * cos - y * sin, piece.y + x * sin + y * cos]);
}

function drawGrid() {
  const [left, top] = toPlan(box.left, box.top), [right, bottom] = toPlan(box.right, box.bottom);
  const step = view.scale > 35 ? 0.5 : view.scale > 8 ? 1 : 5;
  for (let x = Math.ceil(left / step) * step; x < right; x += step) {
    const [px] = toPage(x, 0);
    made("line", { x1: px, x2: px, y1: 0, y2: box.height, class: x % 1 ? "grid" : "grid metre" });
  }
  for (let y = Math.ceil(bottom / step) * step; y < top; y += step) {
    const [, py] = toPage(0, y);
    made("line", { x1: 0, x2: box.width, y1: py, y2: py, class: y % 1 ? "grid" : "grid metre" });
  }
}

function drawTemplate(template) {
  if (!template) return;
  const [x, y] = toPage(template.x, template.y);
  const size = template.scale * view.scale;
  made("image", {
    href: `/${template.file}`, x, y: y - template.height * size, width: template.width * size,
    height: template.height * size, opacity: 0.45, preserveAspectRatio: "none",
  });
}

function drawPlan(plan, judged, selection) {
  const mark = element => { if (selection.includes(element.dataset.item)) element.classList.add("chosen"); };
  for (const room of judged.rooms) {
    polygon(room.corners, "room");
    label(`${room.name}  ${room.area.toFixed(1)} m²`, ...room.middle);
  }
  plan.zones.forEach((zone, i) => {
    mark(polygon(zone.corners, `zone ${zone.kind}`, `zones/${i}`));
  });
  plan.walls.forEach((wall, i) => {
    mark(polygon(stretch(wall, -wall.thickness / 2, wallLength(wall) + wall.thickness / 2), "wall", `walls/${i}`));
    (wall.openings || []).forEach((each, k) => {
      const shape = stretch(wall, each.at - each.width / 2, each.at + each.width / 2, wall.thickness + 0.02);
      mark(polygon(shape, each.kind, `walls/${i}/openings/${k}`));
    });
  });
  plan.furniture.forEach((piece, i) => {
    mark(polygon(furnitureCorners(piece), "furniture", `furniture/${i}`));
    if (piece.kind !== "outline") label(piece.name || piece.kind, piece.x, piece.y);
  });
  plan.places.forEach((place, i) => mark(arrow(place, "place", `places/${i}`, place.name)));
  plan.rooms.forEach((room, i) => {
    const [x, y] = toPage(room.x, room.y);
    const dot = made("circle", { cx: x, cy: y + 8, r: 4, class: "place" });
    dot.dataset.item = `rooms/${i}`;
    mark(dot);
  });
  mark(arrow(plan.start, "start", "start", "start"));
}

function arrow({ x, y, yaw }, kind, item, name) {
  const corners = [[0.22, 0], [-0.15, 0.14], [-0.15, -0.14]].map(([along, across]) => [
    x + along * Math.cos(yaw) - across * Math.sin(yaw), y + along * Math.sin(yaw) + across * Math.cos(yaw)]);
  label(name, x, y - 0.35);
  return polygon(corners, kind, item);
}

function handlesOf(item, path) {  // points by the name of the handle
  const ahead = (distance, yaw) => [item.x + distance * Math.cos(yaw), item.y + distance * Math.sin(yaw)];
  if (path.includes("openings")) return {};
  if (item.end) return { start: item.start, end: item.end };
  if (path.startsWith("zones")) return Object.fromEntries(item.corners.map((corner, k) => [`corner${k}`, corner]));
  if (item.size) {
    const corners = item.corners ? [] : furnitureCorners(item).map((corner, k) => [`corner${k}`, corner]);
    return { turn: ahead(item.size[1] / 2 + 0.3, item.yaw + Math.PI / 2), ...Object.fromEntries(corners) };
  }
  return item.yaw === undefined ? {} : { turn: ahead(0.5, item.yaw) };
}

function drawHandles(item, path) {
  for (const [name, point] of Object.entries(handlesOf(item, path))) {
    const [x, y] = toPage(...point);
    made("circle", { cx: x, cy: y, r: 6, class: name === "turn" ? "handle turn" : "handle" }).dataset.handle = `${path}#${name}`;
  }
}

function drawProblems(problems) {
  for (const problem of problems) {
    const [x, y] = toPage(problem.x, problem.y);
    made("circle", { cx: x, cy: y, r: 13, class: problem.is_error ? "problem error" : "problem", "pointer-events": "none" });
  }
}

function drawPreview() {
  if (drag && drag.area) {
    const [[x1, y1], [x2, y2]] = [drag.area, pointer];
    polygon([[x1, y1], [x2, y1], [x2, y2], [x1, y2]], "area");
  }
  if (!points.length) return;
  const aim = tool === "scale" ? pointer : snapped(pointer);
  if (tool === "wall") {
    const last = points[points.length - 1];
    const wall = { start: last, end: aim, ...newWall };
    polygon(stretch(wall, 0, wallLength(wall)), "preview");
    label(typed ? `${typed} m` : `${wallLength(wall).toFixed(2)} m`, (last[0] + aim[0]) / 2, (last[1] + aim[1]) / 2 + 0.15);
  } else {
    polygon(points.length < 2 ? [...points, aim] : points, "preview");
    if (typed) label(`${typed} m`, ...points[points.length - 1]);
  }
}
