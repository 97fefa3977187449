// Leading the hand. The robot hears nothing but what is held right now: the hand stops by itself when no more comes.
"use strict";
const HAND_KEYS = {
  KeyW: [1, 0, 0, 0, 0, 0], KeyS: [-1, 0, 0, 0, 0, 0], KeyA: [0, 1, 0, 0, 0, 0], KeyD: [0, -1, 0, 0, 0, 0],
  KeyR: [0, 0, 1, 0, 0, 0], KeyF: [0, 0, -1, 0, 0, 0], KeyQ: [0, 0, 0, 0, 0, 1], KeyE: [0, 0, 0, 0, 0, -1],
  ArrowUp: [0, 0, 0, 0, -1, 0], ArrowDown: [0, 0, 0, 0, 1, 0], ArrowLeft: [0, 0, 0, -1, 0, 0], ArrowRight: [0, 0, 0, 1, 0, 0],
};
const STILL = [0, 0, 0, 0, 0, 0];
const FINGER_BUTTONS = { 0: "close", 1: "open" }; // A and B of the standard gamepad

function setUpHand(act) {
  const pad = document.getElementById("handpad");
  const button = document.getElementById("hand");
  const drivePad = document.getElementById("pad");
  const held = new Map();
  let leading = false, home = false, fingers = "", pressed = "";

  const letGo = () => { held.clear(); home = false; };
  button.onclick = () => {
    pad.hidden = !pad.hidden;
    button.classList.toggle("on", !pad.hidden);
    button.blur();
    if (!pad.hidden && !drivePad.hidden) document.getElementById("drive").click(); // one of the two has keys and sticks
    letGo();
  };
  document.getElementById("drive").addEventListener("click", () => {
    if (!drivePad.hidden && !pad.hidden) button.click();
  });
  window.addEventListener("keydown", (event) => {
    if (pad.hidden || typing(event.target) || event.ctrlKey || event.metaKey) return;
    if (event.code === "KeyO" || event.code === "KeyC") { if (!event.repeat) fingers = event.code === "KeyO" ? "open" : "close"; }
    else if (event.code in HAND_KEYS) held.set(event.code, HAND_KEYS[event.code]);
    else return;
    event.preventDefault();
  });
  window.addEventListener("keyup", (event) => held.delete(event.code));
  for (const key of pad.querySelectorAll("[data-hand]")) {
    key.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      if (key.dataset.hand === "home") home = true;
      else if (key.dataset.hand === "open" || key.dataset.hand === "close") fingers = key.dataset.hand;
      else held.set(key, key.dataset.hand.split(" ").map(Number));
    });
    for (const name of ["pointerup", "pointercancel", "pointerleave"]) {
      key.addEventListener(name, () => { held.delete(key); if (key.dataset.hand === "home") home = false; });
    }
    key.addEventListener("contextmenu", (event) => event.preventDefault());
  }
  window.addEventListener("blur", letGo);
  document.addEventListener("visibilitychange", letGo);

  // Left stick: forward and aside. Right stick: up and turn. Nothing without a shoulder button.
  function stick() {
    const [one] = grippedPads();
    if (!one) return STILL;
    const down = Object.keys(FINGER_BUTTONS).find((i) => one.buttons[i] && one.buttons[i].pressed) || "";
    if (down && down !== pressed) fingers = FINGER_BUTTONS[down];
    pressed = down;
    const [x, y, yaw, z] = [-one.axes[1], -one.axes[0], -one.axes[2], -one.axes[3]].map(deflection);
    return [x, y, z, 0, 0, yaw];
  }

  setInterval(() => {
    const away = pad.hidden || document.hidden;
    const wish = away ? STILL : together([...held.values(), stick()]);
    const moves = !away && (home || fingers !== "" || wish.some((v) => v !== 0));
    if (moves || leading) act("hand", home && !away ? "home" : `${shares(wish)} ${away ? "" : fingers}`.trim());
    leading = moves;
    fingers = "";
  }, DRIVE_PERIOD);
}
