// Driving by hand. The robot hears nothing but what is held right now: it stops by itself when no more comes.
"use strict";
const DRIVE_PERIOD = 50; // ms
const DRIVE_KEYS = {
  ArrowUp: [1, 0, 0], KeyW: [1, 0, 0], ArrowDown: [-1, 0, 0], KeyS: [-1, 0, 0], KeyA: [0, 1, 0], KeyD: [0, -1, 0],
  ArrowLeft: [0, 0, 1], KeyQ: [0, 0, 1], ArrowRight: [0, 0, -1], KeyE: [0, 0, -1],
};
const SHOULDERS = [4, 5, 6, 7]; // buttons of the standard gamepad, one of which must be held
const DEAD_ZONE = 0.15;

// The gamepads whose shoulder button is held; without one the sticks mean nothing.
function grippedPads() {
  const pads = navigator.getGamepads ? [...navigator.getGamepads()] : [];
  return pads.filter((one) => one && SHOULDERS.some((i) => one.buttons[i] && one.buttons[i].pressed));
}
const deflection = (v) => (Math.abs(v) < DEAD_ZONE ? 0 : v || 0);
const together = (wishes) => wishes.reduce((a, b) => a.map((v, i) => v + b[i]));
const shares = (wish) => wish.map((v) => Math.max(-1, Math.min(1, v)).toFixed(2)).join(" ");

function setUpDrive(act) {
  const pad = document.getElementById("pad");
  const button = document.getElementById("drive");
  const held = new Map();
  let driving = false;

  const letGo = () => held.clear();
  button.onclick = () => {
    pad.hidden = !pad.hidden;
    button.classList.toggle("on", !pad.hidden);
    button.blur();
    letGo();
  };
  window.addEventListener("keydown", (event) => {
    if (pad.hidden || typing(event.target) || !(event.code in DRIVE_KEYS) || event.ctrlKey || event.metaKey) return;
    event.preventDefault();
    held.set(event.code, DRIVE_KEYS[event.code]);
  });
  window.addEventListener("keyup", (event) => held.delete(event.code));
  for (const key of pad.querySelectorAll("[data-drive]")) {
    key.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      held.set(key, key.dataset.drive.split(" ").map(Number));
    });
    for (const name of ["pointerup", "pointercancel", "pointerleave"]) key.addEventListener(name, () => held.delete(key));
    key.addEventListener("contextmenu", (event) => event.preventDefault());
  }
  window.addEventListener("blur", letGo);
  document.addEventListener("visibilitychange", letGo);

  function stick() {
    const [one] = grippedPads();
    return one ? [-one.axes[1], -one.axes[0], -one.axes[2]].map(deflection) : [0, 0, 0];
  }

  setInterval(() => {
    const wish = pad.hidden || document.hidden ? [0, 0, 0] : together([...held.values(), stick()]);
    const moves = wish.some((v) => v !== 0);
    if (moves || driving) act("drive", shares(wish));
    driving = moves;
  }, DRIVE_PERIOD);
}
