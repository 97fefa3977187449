// All robots on one page: asks once a second, and says when it is not answered.
"use strict";
const $ = (id) => document.getElementById(id);
const COLOURS = ["#4dabf7", "#ffd43b", "#69db7c", "#da77f2", "#ff922b", "#66d9e8", "#f783ac", "#a9e34b"];
const nameOf = (robot) => robot || "(no namespace)";
let grid = null, gridAt = -1;

const act = (what) => fetch("/act", { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(what) })
  .then((answer) => { if (!answer.ok) throw new Error(answer.status); })
  .catch(() => { $("link").textContent = "not sent: connection lost"; });

$("stop").onclick = () => act({ do: "stop", robot: null });
$("say").onsubmit = (event) => {
  event.preventDefault();
  const text = $("text").value.trim();
  if (text) act({ do: "say", text, hand_over: $("over").checked });
  $("text").value = "";
};
window.addEventListener("keydown", (event) => {
  if (event.code !== "Space" || event.repeat || (event.target.tagName === "INPUT" && event.target.type !== "checkbox")) return;
  event.preventDefault();
  act({ do: "stop", robot: null });
}, true);

function cell(row, text, kind) {
  const made = row.insertCell();
  made.textContent = text;
  if (kind) made.className = kind;
  return made;
}

function button(at, text, what, kind) {
  const made = document.createElement("button");
  made.textContent = text;
  made.className = kind || "";
  made.onclick = () => act(what);
  at.append(made, " ");
}

// Rows are made anew only when what they say has changed, so that a button is not replaced under a finger.
let before = "";
function list(robots) {
  const same = JSON.stringify(robots.map((r) => [r.name, r.state, r.command, r.question, r.detail, r.holding, r.braked, !!r.lost, Math.round(100 * r.battery)]));
  if (same === before) return;
  before = same;
  $("robots").replaceChildren();
  robots.forEach((r, i) => {
    const row = $("robots").insertRow();
    cell(row, "●").style.color = COLOURS[i % COLOURS.length];
    cell(row, nameOf(r.name));
    cell(row, r.lost ? "LOST" : r.braked ? "STOPPED" : r.state || "no answer", r.lost ? "lost" : r.braked ? "braked" : "");
    const does = cell(row, r.question || r.command || r.detail, r.question ? "question" : "");
    if (r.holding) { const small = document.createElement("small"); small.textContent = `holds the ${r.holding}`; does.append(small); }
    cell(row, r.battery === null ? "" : `${Math.round(100 * r.battery)} %`);
    const buttons = cell(row, "");
    button(buttons, "STOP", { do: "stop", robot: r.name }, "stop");
    if (r.question) {
      button(buttons, "Yes", { do: "answer", robot: r.name, yes: true });
      button(buttons, "No", { do: "answer", robot: r.name, yes: false });
    }
  });
}

function orders(all) {
  $("orders").replaceChildren();
  for (const one of all) {
    const row = $("orders").insertRow();
    cell(row, one.text);
    cell(row, one.by === null ? "" : nameOf(one.by));
    const state = cell(row, one.state);
    for (const line of one.lines) { const small = document.createElement("small"); small.textContent = line; state.append(small); }
  }
}

async function unpack(map) {
  const packed = Uint8Array.from(atob(map.cells), (c) => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const cells = new Uint8Array(await new Response(stream).arrayBuffer());
  const picture = new ImageData(map.width, map.height);
  for (let row = 0; row < map.height; row++) {
    for (let column = 0; column < map.width; column++) {
      const value = cells[row * map.width + column], at = 4 * ((map.height - 1 - row) * map.width + column);
      const shade = value === 0 ? 120 : value * map.far / 255 < 0.31 ? 55 : 38;
      picture.data.set([shade, shade, shade + 6, 255], at);
    }
  }
  return createImageBitmap(picture);
}

async function draw(robots, map) {
  if (!map) return;
  if (map.t !== gridAt) { gridAt = map.t; grid = await unpack(map); }
  const canvas = $("map"), pen = canvas.getContext("2d");
  const scale = Math.min(canvas.width / map.width, canvas.height / map.height);
  pen.clearRect(0, 0, canvas.width, canvas.height);
  pen.imageSmoothingEnabled = false;
  pen.drawImage(grid, 0, 0, map.width * scale, map.height * scale);
  robots.forEach((r, i) => {
    if (!r.pose) return;
    const [x, y, theta] = r.pose;
    const px = (x - map.x) / map.resolution * scale, py = (map.height - (y - map.y) / map.resolution) * scale;
    const size = 0.28 / map.resolution * scale;
    pen.globalAlpha = r.lost ? 0.4 : 1;
    pen.fillStyle = pen.strokeStyle = COLOURS[i % COLOURS.length];
    pen.beginPath(); pen.arc(px, py, size, 0, 2 * Math.PI); pen.fill();
    pen.lineWidth = 3;
    pen.beginPath(); pen.moveTo(px, py); pen.lineTo(px + 2 * size * Math.cos(theta), py - 2 * size * Math.sin(theta)); pen.stroke();
    pen.fillText(nameOf(r.name), px + size + 3, py - size);
    pen.globalAlpha = 1;
  });
}

async function look() {
  try {
    const answer = await fetch("/state");
    if (!answer.ok) throw new Error(answer.status);
    const state = await answer.json();
    $("link").textContent = `${state.robots.length} robots`;
    list(state.robots);
    orders(state.orders);
    await draw(state.robots, state.map);
  } catch (error) {
    $("link").textContent = "connection lost: what the robots do is not known";
  }
  setTimeout(look, 1000);
}
look();
