// The bar above the 3-D view: stop, commands, microphone, the robot's voice.
"use strict";
const $ = (id) => document.getElementById(id);
const RATE = 16000;
let live = null;
let retry = 200;

function connect() {
  live = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live`);
  live.binaryType = "arraybuffer";
  live.onopen = () => { retry = 200; link("connected", false); };
  live.onclose = () => {
    link("connection lost", true);
    setTimeout(connect, retry);
    retry = Math.min(retry * 2, 3000);
  };
  live.onmessage = (event) => {
    if (event.data instanceof ArrayBuffer) { play(event.data); return; }
    const { kind, value } = JSON.parse(event.data);
    if (kind === "state") show(value);
  };
}

function link(text, lost) {
  $("link").textContent = text;
  $("link").classList.toggle("lost", lost);
  if (lost) { $("state").textContent = "?"; $("detail").textContent = "what the robot does is not known"; }
}

function send(message) {
  if (live && live.readyState === WebSocket.OPEN) live.send(message);
}
const act = (what, text = "") => send(JSON.stringify({ do: what, text }));

const since = (s) => (s < 60 ? `${s} s` : `${Math.floor(s / 60)}:${String(s % 60).padStart(2, "0")} min`);

function show(s) {
  document.body.dataset.state = s.state;
  $("state").textContent = s.stopped ? "STOPPED" : s.state || "no brain";
  const { mission, last } = s;
  // While a mission is under way it is what counts; how the last one ended is told between missions.
  const doing = mission ? [`“${mission.command}”`, since(mission.seconds), mission.step, s.detail] : [];
  const ended = !mission && last ? `${last.command}: ${last.outcome}` : "";
  const told = s.state === "COMPLETED" ? ended || s.detail : s.detail || ended;
  const idle = s.stopped ? (s.left ? `“${s.left}” was cut short` : "the brake is on until you release it") : told;
  $("detail").textContent = mission ? doing.filter(Boolean).join(" · ") : idle;
  $("now").title = $("detail").textContent;
  document.body.dataset.outcome = last ? last.outcome : "";
  $("stop").classList.toggle("braked", s.stopped);
  $("goon").hidden = !s.stopped || !s.left;
  $("goon").title = `Release the brake and go on with “${s.left}”`;
  $("resume").hidden = !s.stopped;
  $("resume").textContent = s.left ? "Release only" : "Release";
  $("resume").title = "Release the brake; nothing is gone on with";
  $("ask").hidden = !s.asking;
  offer(s.question || "Is that right?", s.offered);
  $("talk").classList.toggle("on", s.listening);
  if (!s.sim) link("no simulation or robot", false);
  else if (live.readyState === WebSocket.OPEN) link("connected", false);
}

// A question between things has a button for each of them instead of a yes.
function offer(question, offered) {
  if ($("question").textContent === question) return;
  $("question").textContent = question;
  $("yes").hidden = offered.length > 0;
  $("no").textContent = offered.length ? "None" : "No";
  $("offered").replaceChildren(...offered.map((name) => {
    const button = document.createElement("button");
    button.textContent = name;
    button.onclick = () => act("say", name);
    return button;
  }));
}

$("stop").onclick = () => act("stop");
$("goon").onclick = () => act("go on");
$("resume").onclick = () => act("resume");
$("yes").onclick = () => act("yes");
$("no").onclick = () => act("no");
$("say").onsubmit = (event) => {
  event.preventDefault();
  const text = $("text").value.trim();
  if (text) act("say", text);
  $("text").value = "";
};
$("name").onclick = () => {
  const text = $("text").value.trim();
  if (text) act("name", text);
  else { $("text").placeholder = "type its name first"; $("text").focus(); }
  $("text").value = "";
};

// keys.js, here and in the view, says when the space bar was pressed.
window.addEventListener("message", (event) => {
  if (event.source !== window && event.source !== $("view").contentWindow) return;
  if (event.data === "stop") act("stop");
  else if (event.data && event.data.restart && confirm(`Restart ${event.data.restart}? A mission goes on afterwards.`)) {
    act("restart", event.data.restart);
  }
});

// --- microphone
let microphone = null;
let holder = null; // the pointer that holds the button: somebody talks

async function openMicrophone() {
  const stream = await navigator.mediaDevices.getUserMedia({
    audio: { channelCount: 1, echoCancellation: true, noiseSuppression: true, autoGainControl: true },
  });
  const context = new AudioContext({ sampleRate: RATE });
  await context.audioWorklet.addModule("/page/recorder.js");
  const node = new AudioWorkletNode(context, "recorder", { numberOfOutputs: 0 });
  node.port.onmessage = (event) => { if (holder !== null) send(event.data); };
  context.createMediaStreamSource(stream).connect(node);
  return { stream, context };
}

async function talkStart(event) {
  event.preventDefault();
  if (holder !== null) return;
  holder = event.pointerId;
  // The button moves as its words change, and is held still by a pointer that was over it.
  if (event.isTrusted) $("talk").setPointerCapture(holder);
  $("talk").textContent = "…";
  try {
    microphone = microphone || (await openMicrophone());
    await microphone.context.resume();
    if (holder !== null) $("talk").textContent = "Talking";
  } catch (error) {
    holder = null;
    $("talk").textContent = "No microphone";
    $("talk").title = String(error);
  }
}

function talkEnd(event) {
  if (holder === null || (event.type !== "blur" && event.pointerId !== holder)) return;
  holder = null;
  $("talk").textContent = "Hold to talk";
  send(new ArrayBuffer(0));
}
$("talk").addEventListener("pointerdown", talkStart);
for (const name of ["pointerup", "pointercancel", "pointerleave"]) $("talk").addEventListener(name, talkEnd);
window.addEventListener("blur", talkEnd);

// --- the robot's voice
let speaker = null;
let until = 0;

function play(buffer) {
  if (!$("voice").checked) return;
  speaker = speaker || new AudioContext();
  const rate = new DataView(buffer).getUint32(0, true);
  const raw = new Int16Array(buffer, 4);
  if (!raw.length || speaker.state === "suspended") return;
  const samples = Float32Array.from(raw, (v) => v / 32768);
  const piece = speaker.createBuffer(1, samples.length, rate);
  piece.copyToChannel(samples, 0);
  const source = speaker.createBufferSource();
  source.buffer = piece;
  source.connect(speaker.destination);
  until = Math.max(until, speaker.currentTime + 0.05);
  source.start(until);
  until += piece.duration;
}
// Browsers let a page sound only after the visitor has done something.
window.addEventListener("pointerdown", () => { speaker = speaker || new AudioContext(); speaker.resume(); }, { once: true });

setUpDrive(act);
setUpHand(act);
connect();
