"""The 3-D view: the model's meshes in viser, posed by the robot's joints and pose estimate."""

from typing import Any

import numpy as np
import viser

from common import messages as m
from common.geometry import Array, Pose2, matrix_quat, transformed
from common.kinds import kind_of
from common.naming.colours import COLOURS, UNKNOWN_COLOUR
from common.robot.lidar import rays_of
from services.dashboard.scene.drawing import Drawing, Mesh, posture

GHOST = 0.3
"""Opacity of an object that was not seen for long; chosen: visible, yet not to be mistaken for a fresh sighting."""
STILL = 1e-4
"""Change of a joint [m or rad] below which a link is not sent again: a tenth of a millimetre."""
SCAN_COLOUR, PATH_COLOUR = (255, 60, 60), (40, 160, 255)
"""Of the lidar's points and of the path (red, green, blue, 0 to 255); chosen: told apart on floor and walls."""
LIDAR_HEIGHT = 0.2
"""Of the lidar's points in the view [m]: about the slot in the base that it looks out of."""
PART = 1.0
"""Height [m] of the names of rooms and surfaces: above tables, below the robot's head."""
FRUSTUM = 0.25
"""Length [m] of the head camera's drawn frustum; the wrist's is half of it."""


class View:
    """Draws flat, robot and objects into a viser server; to be called from the service's thread."""

    def __init__(self, server: viser.ViserServer) -> None:
        self._server, self._scene = server, server.scene
        self.nodes: dict[str, Any] = {}
        self.object_nodes: dict[str, Any] = {}
        self._looks: dict[str, tuple[object, ...]] = {}
        self._at: dict[str, tuple[Array, Array]] = {}
        self._values: dict[str, list[float]] = {}
        self._scan: Any = None
        self._path: Any = None
        self._paths: dict[str, str] = {}
        self.part_labels: list[Any] = []
        self._shown_parts: tuple[m.HomeParts | None, bool] = (None, False)
        self.drawing = Drawing(None, None)
        self._scene.set_up_direction("+z")
        # Shadows cost more than all else on machines that draw without a graphics card.
        self._scene.configure_default_lights(cast_shadow=False)

    # --- the model
    def show(self, found: Drawing) -> None:
        """Replace everything by another model."""
        self.drawing = found
        with self._server.atomic():
            for node in (*self.nodes.values(), *(n for nodes in self.object_nodes.values() for n in nodes)):
                node.remove()
            for each in (self.nodes, self.object_nodes, self._looks, self._at, self._values):
                each.clear()
            if found.flat is not None:
                self.nodes["flat"] = self._mesh("/flat", found.flat)
            if found.walls is not None:
                self.nodes["walls"] = self._scene.add_mesh_simple(
                    "/walls",
                    found.walls.vertices.astype(np.float32),
                    found.walls.faces.astype(np.uint32),
                    color=_rgb(found.walls),
                    opacity=0.45,
                    flat_shading=True,
                    side="double",
                    cast_shadow=False,
                )
            paths: dict[str, str] = {}
            for link in found.links:
                path = f"{paths.get(link.parent, '/robot')}/{link.name}"
                paths[link.name] = path
                place, turn = posture(link, {})
                if link.mesh is not None:
                    node = self._mesh(path, link.mesh)
                else:
                    node = self._scene.add_frame(path, show_axes=False)
                node.position, node.wxyz = place, matrix_quat(turn)
                self.nodes[path], self._at[path] = node, (place, turn)
            for camera in found.cameras:
                self.nodes[f"camera {camera.name}"] = self._scene.add_camera_frustum(
                    f"{paths[camera.link]}/{camera.name}_camera",
                    fov=camera.fovy,
                    aspect=4 / 3,
                    thickness=0.008,
                    scale=FRUSTUM if camera.name == "head" else FRUSTUM / 2,
                    color=(250, 200, 60),
                    position=camera.position,
                    wxyz=matrix_quat(camera.rotation),
                )
            self._paths = paths

    def _mesh(self, name: str, mesh: Mesh) -> Any:
        import trimesh

        colours = np.concatenate([mesh.colours, np.ones((len(mesh.colours), 1))], axis=1)
        # Faces must not share corners, or light would be smeared over the edges of boxes.
        order = mesh.faces.reshape(-1)
        faces = np.arange(len(order)).reshape(-1, 3)
        shape = trimesh.Trimesh(mesh.vertices[order], faces, process=False)
        shape.visual = trimesh.visual.ColorVisuals(shape, vertex_colors=(colours[order] * 255).astype(np.uint8))
        return self._scene.add_mesh_trimesh(name, shape)

    # --- the robot
    def pose(self, joints: dict[str, float], base: Pose2, width: float) -> None:
        """Pose the robot by its joints; `base` is its pose [map], `width` the gripper's [m]."""
        q = {**joints, "base_x": base[0], "base_y": base[1], "base_yaw": base[2]}
        if self.drawing.hand is not None:
            q |= zip(self.drawing.hand.joints, self.drawing.hand.posture(width).tolist(), strict=True)
        for link in self.drawing.links:
            if not link.joints:
                continue
            path = self._paths[link.name]
            values = [q.get(joint.name, 0.0) for joint in link.joints]
            drawn = self._values.get(path)
            if drawn is not None and max(abs(a - b) for a, b in zip(values, drawn, strict=True)) < STILL:
                continue
            self._values[path] = values
            place, turn = posture(link, q)
            before = self._at[path]
            if np.abs(place - before[0]).max() > STILL:
                self.nodes[path].position = place
            if np.abs(turn - before[1]).max() > STILL:
                self.nodes[path].wxyz = matrix_quat(turn)
            self._at[path] = place, turn

    # --- what it senses and believes
    def scan(self, scan: m.LaserScan, base: Pose2, visible: bool) -> None:
        """Draw what the lidar meets around `base` (frame map).

        Raises:
            ValueError: it is not the scan of a lidar.
        """
        rays = rays_of(scan)
        ends = transformed(base, rays.ends[rays.hit])
        points = np.column_stack([ends, np.full(len(ends), LIDAR_HEIGHT)])
        if self._scan is None:
            self._scan = self._scene.add_point_cloud(
                "/scan", points.astype(np.float32), SCAN_COLOUR, point_size=0.03, point_shape="circle",
                precision="float32",
            )  # fmt: skip
        else:
            self._scan.points = points.astype(np.float32)
        self._scan.visible = visible

    def path(self, points: list[tuple[float, float]]) -> None:
        """Draw the planned path through points [m], frame map; none for fewer than two."""
        if self._path is not None:
            self._path.remove()
            self._path = None
        if len(points) > 1:
            line = np.array([(x, y, 0.02) for x, y in points], dtype=np.float32)
            segments = np.stack([line[:-1], line[1:]], axis=1)
            self._path = self._scene.add_line_segments("/path", segments, PATH_COLOUR, thickness=0.03)

    def objects(self, known: list[m.WorldObject], t: float, ghost_after: float, labels: bool) -> None:
        """Draw what the robot believes; what it has not seen for `ghost_after` seconds as a ghost."""
        names = [one.id or one.label for one in known]
        for gone in [k for k in self._looks if k not in names]:
            for node in self.object_nodes.pop(gone):
                node.remove()
            del self._looks[gone]
        for name, one in zip(names, known, strict=True):
            ghost = not one.held and t - one.seen_at > ghost_after
            look = (one.label, one.kind, one.colour, one.size, ghost, labels)
            if self._looks.get(name, ())[:-1] != look:
                for node in self.object_nodes.pop(name, ()):
                    node.remove()
                self.object_nodes[name] = self._object(name, one, ghost, labels)
            elif self._looks[name][-1] == (one.position, one.orientation):
                continue
            body, *label = self.object_nodes[name]
            body.position, body.wxyz = one.position, one.orientation
            for each in label:
                each.position = _above(one)
            self._looks[name] = (*look, (one.position, one.orientation))

    def parts(self, known: m.HomeParts | None, labels: bool) -> None:
        """Write the names of rooms, surfaces and places where they are."""
        shown = (known, labels)
        if shown == self._shown_parts:
            return
        self._shown_parts = shown
        for node in self.part_labels:
            node.remove()
        parts = known.parts if known is not None and labels else []
        # A standing place is often called by its room, which has its name already.
        rooms = {one.name for one in parts if one.kind == "room"}
        parts = [one for one in parts if one.kind == "room" or one.name not in rooms]
        self.part_labels = [
            self._scene.add_label(f"/parts/{n}", one.name, position=(one.x, one.y, PART), font_screen_scale=0.7)
            for n, one in enumerate(parts)
        ]

    def _object(self, name: str, one: m.WorldObject, ghost: bool, labels: bool) -> tuple[Any, ...]:
        mesh = self.drawing.objects.get(one.label) or fallback(one.kind, one.size, one.colour)
        path = f"/objects/{name}"
        body = self._scene.add_mesh_simple(
            path,
            mesh.vertices.astype(np.float32),
            mesh.faces.astype(np.uint32),
            color=_rgb(mesh),
            opacity=GHOST if ghost else None,
            side="double",
        )
        if not labels:
            return (body,)
        text = f"{one.label}?" if ghost else one.label
        return body, self._scene.add_label(f"/names/{name}", text, position=_above(one), font_screen_scale=0.8)


def _above(one: m.WorldObject) -> tuple[float, float, float]:
    x, y, z = one.position
    return x, y, z + one.size[2] / 2 + 0.08


def _rgb(mesh: Mesh) -> tuple[int, int, int]:
    """The colour of most of it."""
    colours, counts = np.unique(np.round(mesh.colours * 255).astype(int), axis=0, return_counts=True)
    r, g, b = (int(v) for v in colours[int(np.argmax(counts))])
    return r, g, b


# --- shapes for objects that no model shows
def fallback(kind: str, size: tuple[float, float, float], colour: str) -> Mesh:
    """An object that no model shows: a shape of its kind, size and colour."""
    import trimesh

    x, y, z = (max(s, 0.02) for s in size)
    solid = kind_of(kind).shape
    if solid == "sphere":
        shape = trimesh.creation.icosphere(subdivisions=2)
        shape.apply_scale([x / 2, y / 2, z / 2])
    elif solid == "turned":
        shape = trimesh.creation.cylinder(radius=(x + y) / 4, height=z, sections=24)
    else:
        shape = trimesh.creation.box(extents=[x, y, z])
    vertices = np.asarray(shape.vertices, dtype=np.float64)
    rgb = np.array(COLOURS.get(colour, UNKNOWN_COLOUR))
    return Mesh(vertices, np.asarray(shape.faces, dtype=np.int64), np.tile(rgb, (len(vertices), 1)))
