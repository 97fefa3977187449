// A recording instead of a robot: play, pause and the time slider take the place of what commands a robot.
"use strict";
const tape = { playing: false, held: false };

function showTape(now) {
  const at = (id) => document.getElementById(id);
  if (at("tape").hidden) {
    at("tape").hidden = false;
    for (const id of ["stop", "goon", "resume", "ask", "say", "talk", "voice"]) at(id).closest("label, form, div, button").classList.add("gone");
    at("scrub").min = now.first;
    at("scrub").max = now.last;
    const share = (t) => (100 * (Math.min(Math.max(t, now.first), now.last) - now.first)) / Math.max(now.last - now.first, 0.1);
    at("bands").replaceChildren(...now.bands.map((band) => {
      const part = document.createElement("i");
      part.title = band.state;
      part.style.cssText = `left:${share(band.from)}%;width:${share(band.to) - share(band.from)}%;background:${band.colour}`;
      return part;
    }));
  }
  tape.playing = now.playing;
  at("play").textContent = now.playing ? "Pause" : "Play";
  at("when").textContent = `${now.t.toFixed(1)} s of ${now.last.toFixed(1)} s`;
  if (!tape.held) at("scrub").value = now.t;
}

function setUpTape(act) {
  const scrub = document.getElementById("scrub");
  scrub.addEventListener("pointerdown", () => { tape.held = true; });
  for (const name of ["pointerup", "pointercancel", "change"]) scrub.addEventListener(name, () => { tape.held = false; });
  scrub.addEventListener("input", () => act("seek", scrub.value));
  document.getElementById("play").onclick = () => act(tape.playing ? "pause" : "play");
  document.getElementById("speed").onchange = (event) => act("speed", event.target.value);
}
