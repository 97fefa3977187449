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
// Buttons in the panels that the page beside the view understands.
document.addEventListener("click", (event) => {
  const button = event.target.closest && event.target.closest("[data-restart]");
  if (button) window.parent.postMessage({ restart: button.dataset.restart }, "*");
});
// viser tells everybody who draws without a graphics card that they do; a robot's computer often does.
if (window.parent !== window) {
  for (const kind of [window.WebGLRenderingContext, window.WebGL2RenderingContext]) {
    if (!kind) continue;
    const extension = kind.prototype.getExtension;
    kind.prototype.getExtension = function (name) {
      return name === "WEBGL_debug_renderer_info" ? null : extension.call(this, name);
    };
  }
}
