// The space bar stops the robot wherever the focus is, except while words are being typed.
"use strict";
const typing = (at) =>
  at && (at.isContentEditable || at.tagName === "TEXTAREA" || (at.tagName === "INPUT" && at.type !== "checkbox"));
window.addEventListener("keydown", (event) => {
  if (event.code !== "Space" || typing(event.target)) return;
  event.preventDefault();
  event.stopImmediatePropagation();
  if (!event.repeat) window.parent.postMessage("stop", "*");
}, true);
// A focused button would be pressed by the same key's release.
window.addEventListener("keyup", (event) => {
  if (event.code === "Space" && !typing(event.target)) event.preventDefault();
}, true);
