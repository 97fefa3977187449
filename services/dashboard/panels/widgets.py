"""The panels beside the 3-D view, made of viser's own elements."""

from functools import partial
from typing import Any

import numpy as np
import viser
import viser.uplot as uplot
from numpy.typing import NDArray

from common.topics import PICTURES
from services.dashboard.panels.history_buffers import Curves

BLANK = np.full((12, 16, 3), 32, np.uint8)


class Panels:
    """Handles of everything beside the view; texts are sent only when they change.

    `follow`, `scan`, `costmap`, `grasps`, `labels` and `clicks` are check boxes, whose `value` a visitor sets.
    """

    def __init__(self, server: viser.ViserServer, width: int, height: int) -> None:
        gui = server.gui
        gui.configure_theme(show_logo=False, show_share_button=False, control_width="large")
        gui.main_panel.dock_right()
        gui.set_panel_label("tidybot")
        self.texts: dict[str, str] = {}
        self._html: dict[str, Any] = {}
        self._images: dict[str, Any] = {}
        self._wanted: dict[str, Any] = {}
        self._plots: list[tuple[Curves, Any]] = []
        tabs = gui.add_tab_group()
        with tabs.add_tab("Mission"):
            self._html["mission"] = gui.add_html("")
            gui.add_divider()
            self._html["transcript"] = gui.add_html("")
        with tabs.add_tab("Tree"):
            self._html["tree"] = gui.add_html("")
        with tabs.add_tab("Camera"):
            blank = np.resize(BLANK, (height, width, 3))
            for name in PICTURES:
                self._wanted[name] = gui.add_checkbox(f"{name} camera", initial_value=name == "head")
                self._images[name] = gui.add_image(
                    blank, jpeg_quality=75, format="jpeg", visible=self._wanted[name].value
                )
                self._wanted[name].on_update(partial(self._show_camera, name))
        with tabs.add_tab("Past"):
            self._html["missions"] = gui.add_html("")
        with tabs.add_tab("Health"):
            self._html["services"] = gui.add_html("")
            # Not in a tab of their own: one more would put the row of tabs into two lines.
            self._plots_below = gui.add_folder("plots")
        with tabs.add_tab("View"):
            self.follow = gui.add_checkbox("follow the robot", initial_value=True)
            self.scan = gui.add_checkbox("lidar", initial_value=True)
            self.costmap = gui.add_checkbox("costmap", initial_value=True)
            self.grasps = gui.add_checkbox("grasp candidates", initial_value=True)
            self.labels = gui.add_checkbox("names of the objects", initial_value=True)
            self.clicks = gui.add_checkbox(
                "clicks command the robot",
                initial_value=True,
                hint="A click on the floor sends the base there, a click on an object has it fetched.",
            )
        self._gui = gui

    def wanted(self, camera: str) -> bool:
        """A visitor wants to see this camera's pictures."""
        return bool(self._wanted[camera].value)

    def _show_camera(self, camera: str, event: Any) -> None:
        """A camera that nobody wants to see leaves no black picture behind."""
        self._images[camera].visible = self._wanted[camera].value

    def text(self, name: str, html: str) -> None:
        """Show HTML in the panel `name`; sent only when it changed."""
        if self.texts.get(name) != html:
            self.texts[name] = html
            self._html[name].content = html

    def picture(self, camera: str, pixels: NDArray[np.uint8]) -> None:
        """Show (height, width, 3) uint8."""
        self._images[camera].image = pixels

    def plot(self, curves: Curves, title: str, unit: str, top: float) -> None:
        """Add a chart of curves; `top` is the least upper end of its axis."""
        colours = ("#1c7ed6", "#e8590c")
        series = [uplot.Series(label="s")]
        series += [uplot.Series(label=n, stroke=c, width=2) for n, c in zip(curves.names, colours, strict=False)]
        with self._plots_below:
            chart = self._gui.add_uplot(
                curves.arrays(),
                tuple(series),
                title=f"{title} [{unit}]",
                scales={"x": uplot.Scale(time=False), "y": uplot.Scale(range=(0, top))},
                height=150,
            )
        self._plots.append((curves, chart))

    def redraw(self) -> None:
        """Send the curves as they are now."""
        for curves, chart in self._plots:
            chart.data = curves.arrays()
