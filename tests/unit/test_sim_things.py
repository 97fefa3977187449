"""Things with faces, and bodies from files: what collides, what is seen, and that they stay where they stand."""

import io
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import msgspec
import mujoco
import numpy as np
import pytest
from PIL import Image
from scipy.spatial import Delaunay

from common.files.body_file import BodyError, extents, load
from common.rendering.looks import geom_colours
from common.scene import Finish, Lamp, ObjectSpec, SceneError, load_scene
from evaluation.suites.drawn import surroundings
from services.sim.layout import Placement
from services.sim.objects import body_xml, made
from services.sim.physics import Physics
from services.sim.robot import HULL_GROUP
from services.sim.things import cells, convex
from services.sim.things.body_file import body as body_of
from services.sim.things.finish import GROUND, picture
from services.sim.things.forms import FORMS
from services.sim.things.mesh import turned
from services.sim.things.primitives import GROUP, materials
from services.sim.things.thinning import mapped

SIZES = {
    "banana": (0.17, 0.06, 0.036), "duck": (0.08, 0.06, 0.07), "car": (0.11, 0.05, 0.05), "boat": (0.13, 0.05, 0.07),
    "screwdriver": (0.20, 0.03, 0.03), "hammer": (0.26, 0.09, 0.03), "spoon": (0.24, 0.045, 0.015),
    "brush": (0.20, 0.05, 0.045),
}  # fmt: skip
FACED = {
    "can": (0.066, 0.066, 0.10), "mug": (0.08, 0.08, 0.095), "cup": (0.075, 0.075, 0.09), "jar": (0.075, 0.075, 0.11),
    "bottle": (0.07, 0.07, 0.23), "bowl": (0.14, 0.14, 0.06), "plate": (0.20, 0.20, 0.025), "box": (0.06, 0.13, 0.19),
    "carton": (0.065, 0.065, 0.18), "book": (0.03, 0.14, 0.21), "ball": (0.065, 0.065, 0.065),
    "lemon": (0.055, 0.055, 0.075),
}  # fmt: skip


def spec(kind: str, size: tuple[float, float, float], **more: Any) -> ObjectSpec:
    return ObjectSpec(name="it", kind=kind, colour="red", size=size, mass=0.25, rgba=(0.8, 0.1, 0.1, 1.0), **more)


def model_of(one: ObjectSpec) -> Any:
    body = made(one)
    xml = body_xml(Placement(one, (0.0, 0.0, 0.0), 0.0, "table"))
    assets = f"<compiler angle='radian'/><asset>{materials([one])}{body.assets}</asset>"
    text = f"<mujoco>{assets}<worldbody>{xml}</worldbody></mujoco>"
    return mujoco.MjModel.from_xml_string(text, body.files)


def corners(model: Any) -> np.ndarray:
    """Corners (n, 3) of the only mesh that is seen in the model's frame: MuJoCo keeps meshes along their own axes."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    (g,) = [g for g in range(model.ngeom) if model.geom_group[g] == GROUP]
    mesh = int(model.geom_dataid[g])
    at = int(model.mesh_vertadr[mesh])
    points = model.mesh_vert[at : at + int(model.mesh_vertnum[mesh])]
    return np.asarray(points @ data.geom_xmat[g].reshape(3, 3).T + data.geom_xpos[g])


def measured(model: Any, group: int) -> np.ndarray:
    """Full extents (3,) of the geoms of a group, by casting many parallel rays from outside along each axis."""
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    groups = np.zeros(6, np.uint8)
    groups[group] = 1
    found = np.zeros(3)
    for axis in range(3):
        others = [a for a in range(3) if a != axis]
        grid = np.stack(np.meshgrid(*[np.linspace(-0.2, 0.2, 161)] * 2), -1).reshape(-1, 2)
        for sign in (1.0, -1.0):
            origin, ray = np.zeros((len(grid), 3)), np.zeros(3)
            origin[:, others], origin[:, axis], ray[axis] = grid, sign * 0.5, -sign
            hit = np.empty(1, np.int32)
            far = [mujoco.mj_ray(model, data, o, ray, groups, 1, -1, hit) for o in origin]
            found[axis] += 0.5 - min((f for f in far if f >= 0), default=0.5)
    return found


@pytest.mark.parametrize(("kind", "size"), FACED.items())
def test_a_face_covers_what_collides(kind: str, size: tuple[float, float, float]) -> None:
    """The mesh that is seen has the extents that are told, and nothing that collides is seen through it."""
    model = model_of(spec(kind, size, label="A LABEL", pattern="band", second=(0.9, 0.9, 0.9, 1.0), gloss=0.5))
    solid = model.geom_contype > 0
    assert set(model.geom_group[solid].tolist()) == {HULL_GROUP} and set(model.geom_group[~solid].tolist()) == {GROUP}
    assert float(model.body_mass[1]) == pytest.approx(0.25, rel=0.01)
    points = corners(model)
    wide = points.max(axis=0) - points.min(axis=0)
    told = np.array(size) + ((0.024, 0, 0) if kind == "mug" else 0)
    if kind == "mug":  # Its handle reaches out on one side.
        wide[0], told[0] = points[:, 0].max(), size[0] / 2 + 0.0268
    assert np.allclose(wide, told, atol=0.002)


@pytest.mark.parametrize(("form", "size"), SIZES.items())
def test_a_form_fills_its_extents(form: str, size: tuple[float, float, float]) -> None:
    one = spec("toy", size, form=form)
    model = model_of(one)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    low, high = np.full(3, 9.0), np.full(3, -9.0)
    for g in range(model.ngeom):
        half = np.abs(data.geom_xmat[g].reshape(3, 3)) @ model.geom_aabb[g, 3:]
        low, high = np.minimum(low, data.geom_xpos[g] - half), np.maximum(high, data.geom_xpos[g] + half)
    assert np.all(high - low < np.array(size) * 1.15 + 0.004), (high - low).round(3)
    assert np.all(high - low > np.array(size) * 0.85 - 0.004), (high - low).round(3)
    assert set(SIZES) == set(FORMS)


def test_the_print_is_on_the_picture_and_the_picture_is_upright() -> None:
    """Letters are dark on the light ground in the middle, and the rim's colour is at the top."""
    (png,) = made(spec("can", FACED["can"], label="SOUP", second=(0.1, 0.1, 0.9, 1.0))).files.values()
    image = np.asarray(Image.open(io.BytesIO(png))).astype(int)
    height = len(image)
    assert image[: height // 30, :, 2].mean() > 200 > image[height // 10 : height // 6, :, 2].mean()
    middle = image[2 * height // 5 : 3 * height // 5]
    assert (middle.min(axis=2) > 180).any(), "white letters on red"
    model = model_of(spec("can", FACED["can"], label="SOUP", second=(0.1, 0.1, 0.9, 1.0)))
    top = corners(model)[:, 2] > 0.049
    at = model.mesh_facetexcoord.ravel()[np.isin(model.mesh_face.ravel(), np.flatnonzero(top))]
    assert model.mesh_texcoord[at, 1].min() < 0.06, "what is at the top takes the picture's upper rows"


def test_things_that_are_drawn_without_pictures_have_their_mean_colour() -> None:
    model = model_of(spec("box", FACED["box"], label="X"))
    (seen,) = np.flatnonzero(model.geom_contype == 0)
    red, green, blue = geom_colours(model)[seen]
    assert red > 0.6 > 0.3 > max(green, blue)


def test_a_geom_of_a_shiny_material_keeps_its_own_colour() -> None:
    model = model_of(spec("can", (0.066, 0.066, 0.115), gloss=0.6))
    assert geom_colours(model)[model.geom_matid >= 0] == pytest.approx(model.geom_rgba[model.geom_matid >= 0, :3])


def test_what_stands_stays() -> None:
    """Plates, books, toys and tools rest where they are put, and none sinks into the table."""
    objects = []
    rows = [(k, s, {"label": "X"}) for k, s in FACED.items()] + [("toy", s, {"form": f}) for f, s in SIZES.items()]
    for n, (kind, size, more) in enumerate(rows):
        place = (4.85 + 0.17 * (n % 6), -1.05 + 0.19 * (n // 6))
        one = ObjectSpec(
            name=f"thing {n}", kind=kind, colour="red", size=size, mass=0.2, rgba=(0.8, 0.1, 0.1, 1.0),
            on="kitchen table", position=place, yaw=1.57 if max(size[:2]) > 0.15 else 0.4, **more,
        )  # fmt: skip
        objects.append(one)
    physics = Physics(msgspec.structs.replace(load_scene("apartment"), objects=tuple(objects)), 0)
    for placed in physics.placements:
        moved = np.linalg.norm(physics.data.xpos[physics.bodies[placed.spec.name]] - placed.position)
        assert moved < 0.012, f"{placed.spec.kind} {placed.spec.form}: {moved:.4f}"


# --- bodies from files
BODY = """<mujoco><asset>
<texture name="t" type="2d" file="halves.png"/><material name="m" texture="t" specular="0.3"/><mesh name="s"
 vertex="-.05 -.03 -.02 .05 -.03 -.02 .05 .03 -.02 -.05 .03 -.02 -.05 -.03 .08 .05 -.03 .08 .05 .03 .08 -.05 .03 .08"
 texcoord="0 1 1 1 0 1 1 1 0 0 1 0 0 0 1 0"
 face="0 2 1 0 3 2 4 5 6 4 6 7 0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7"/>
</asset><worldbody><body name="carton" pos="0.3 0 0.2">{}</body></worldbody></mujoco>"""
LOOK = '<geom type="mesh" mesh="s" material="m" contype="0" conaffinity="0" mass="0"/>'
SOLID = '<geom type="box" size=".05 .03 .05" pos="0 0 .03" group="3" density="300"/>'


def body_file(directory: Path, geoms: str) -> Path:
    image = np.zeros((32, 16, 3), np.uint8)
    image[:16], image[16:] = (255, 0, 0), (0, 0, 255)
    Image.fromarray(image).save(directory / "halves.png")
    path = directory / "carton.xml"
    path.write_text(BODY.format(geoms))
    return path


def world_file(directory: Path, line: str) -> Path:
    path = directory / "world.toml"
    path.write_text(
        f'name = "x"\nplan = "apartment"\nobjects = [{{ name = "it", kind = "carton", colour = "red", {line} }}]\n'
    )
    return path


def test_a_body_file_is_looked_at_and_collides_as_it_says(tmp_path: Path) -> None:
    body_file(tmp_path, LOOK + SOLID)
    (one,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml"'))).objects
    assert one.size == (0.1, 0.06, 0.1)
    model = model_of(one)
    solid = model.geom_contype > 0
    assert solid.sum() == 1 and int(model.geom_type[solid][0]) == mujoco.mjtGeom.mjGEOM_BOX
    assert int(model.geom_group[solid][0]) == HULL_GROUP and int(model.geom_group[~solid][0]) == GROUP
    assert np.allclose(measured(model, HULL_GROUP), one.size, atol=0.004)
    assert float(model.body_mass[1]) == pytest.approx(0.1 * 0.06 * 0.1 * 300, rel=0.02)
    assert np.allclose(model.body_ipos[1], 0.0), "the origin is the middle"


def test_its_picture_is_the_same_and_the_same_way_up(tmp_path: Path) -> None:
    theirs, _ = load(body_file(tmp_path, LOOK.replace("/>", f' group="{GROUP}"/>') + SOLID))
    (one,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml"'))).objects
    ours = model_of(one)
    assert np.array_equal(ours.tex_data, theirs.tex_data)

    def colours(model: Any) -> dict[bool, set[tuple[int, ...]]]:
        """Of the corners above and below the middle, by the texture's rows as MuJoCo keeps them."""
        found: dict[bool, set[tuple[int, ...]]] = {True: set(), False: set()}
        width, height = int(model.tex_width[0]), int(model.tex_height[0])
        pixels = model.tex_data.reshape(height, width, -1)
        heights = corners(model)[:, 2]
        for corner, at in zip(model.mesh_face.ravel(), model.mesh_facetexcoord.ravel(), strict=True):
            v = float(model.mesh_texcoord[at, 1])
            row = min(height - 1, int(v * height))
            found[bool(heights[corner] > heights.mean())].add(tuple(pixels[row, 0, :3].tolist()))
        return found

    assert colours(ours) == colours(theirs) and colours(ours)[True] != colours(ours)[False]


def test_without_colliding_geoms_it_gets_a_hull(tmp_path: Path) -> None:
    body_file(tmp_path, LOOK)
    (one,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml", mass = 0.3'))).objects
    model = model_of(one)
    assert (model.geom_contype > 0).sum() >= 1
    assert np.allclose(measured(model, HULL_GROUP), (0.1, 0.06, 0.1), atol=0.004)
    assert float(model.body_mass[1]) == pytest.approx(0.3)


def test_a_light_model_is_told(tmp_path: Path) -> None:
    body_file(tmp_path, LOOK + SOLID.replace("300", "20"))
    (one,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml"'))).objects
    assert "12 g" in made(one).warning and "mass" in made(one).warning
    (heavy,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml", mass = 0.4'))).objects
    assert not made(heavy).warning


@pytest.mark.parametrize(
    ("text", "expected"),
    [("<mujoco><worldbody/></mujoco>", "no geoms"), ("<mujoco><geom/>", "cannot read"), (None, "no body file")],
)
def test_a_broken_body_file_is_named(tmp_path: Path, text: str | None, expected: str) -> None:
    if text is not None:
        (tmp_path / "carton.xml").write_text(text)
    with pytest.raises(SceneError, match=expected) as error:
        load_scene(str(world_file(tmp_path, 'model = "carton.xml"')))
    assert "'it'" in str(error.value) and "carton.xml" in str(error.value)
    with pytest.raises(BodyError):
        extents(tmp_path / "carton.xml")


def test_large_meshes_are_thinned_and_keep_their_picture(tmp_path: Path) -> None:
    """A ball of 20,000 triangles, red above and blue below."""
    rings, around = 100, 101
    a, b = np.meshgrid(np.linspace(0, np.pi, rings), np.linspace(0, 2 * np.pi, around), indexing="ij")
    points = 0.04 * np.stack([np.sin(a) * np.cos(b), np.sin(a) * np.sin(b), np.cos(a)], -1).reshape(-1, 3)
    uv = np.stack([b.ravel() / (2 * np.pi), a.ravel() / np.pi], 1)
    n = np.arange(rings * around).reshape(rings, around)
    p, q, r, s = n[:-1, :-1].ravel(), n[1:, :-1].ravel(), n[1:, 1:].ravel(), n[:-1, 1:].ravel()
    faces = np.concatenate([np.stack([p, q, r], 1), np.stack([p, r, s], 1)])
    lines = [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in points] + [f"vt {u:.6f} {1 - v:.6f}" for u, v in uv]
    lines += ["f " + " ".join(f"{i + 1}/{i + 1}" for i in f) for f in faces]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    body_file(tmp_path, "")
    (tmp_path / "carton.xml").write_text(
        '<mujoco><asset><texture name="t" type="2d" file="halves.png"/><material name="m" texture="t"/>'
        '<mesh name="b" file="ball.obj"/></asset><worldbody><geom type="mesh" mesh="b" material="m" contype="0" '
        'conaffinity="0"/><geom type="sphere" size=".04" density="300" group="3"/></worldbody></mujoco>'
    )
    (one,) = load_scene(str(world_file(tmp_path, 'model = "carton.xml"'))).objects
    model = model_of(one)
    assert 500 < model.nmeshface < 3000
    heights = corners(model)[model.mesh_face.ravel(), 2]
    upper, lower = heights > 0.01, heights < -0.01
    v = model.mesh_texcoord[model.mesh_facetexcoord.ravel(), 1]
    assert v[upper].max() < 0.5 < v[lower].min() or v[lower].max() < 0.5 < v[upper].min()


# --- lamps and covers
def test_a_cover_gets_no_picture_of_the_many_pages_under_it() -> None:
    square = np.array([[(0, 0, 0), (1, 0, 0), (1, 1, 0)], [(0, 0, 0), (1, 1, 0), (0, 1, 0)]], float)
    # Upright strips that end just under the cover, all over it: their middles are nearer to the new cover's.
    at = np.linspace(0.02, 0.98, 60)
    pages = np.array([[(x, 0, -0.01), (x, 1, -0.01), (x, 0.5, -0.02)] for x in at])
    uv = np.concatenate([np.full((2, 3, 2), 0.1), np.full((60, 3, 2), 0.9)])
    across = np.array([[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0), (0, 1, 0)]], float)
    assert np.allclose(mapped(np.concatenate([square, pages]), uv, across), 0.1)
    assert np.allclose(mapped(np.concatenate([square, pages]), uv, pages[:1]), 0.9)


def test_covers_are_seen_and_change_nothing_else() -> None:
    """A covered flat has the same contacts, the same lidar and, to a millimetre, the same depth; the colours differ."""
    bare = load_scene("apartment")
    covered = msgspec.structs.replace(bare, finish=Finish(floor="tile", walls="brick", tables="cloth"))
    plain, dressed = Physics(bare, 3), Physics(covered, 3)
    assert sorted(dressed.files) == [f"finish_{n}.png" for n in ("brick", "cloth", "tile")] and not plain.files
    assert np.allclose(plain.data.qpos, dressed.data.qpos, atol=1e-6), "nothing rests on a cover"
    down, hit = np.array([0.0, 0.0, -1.0]), np.empty(1, np.int32)
    table = next(r for r in bare.receptacles if r.kind == "table")
    seen = []
    for physics in (plain, dressed):
        groups = np.array([1, 1, 1, 1, 0, 0], np.uint8)
        above = np.array([table.center[0], table.center[1], 2.0])
        wall = bare.walls[0]
        before = np.array([(wall.start[0] + wall.end[0]) / 2, wall.start[1] + 1.0, 2.3])
        depth = [
            mujoco.mj_ray(physics.model, physics.data, above, down, groups, 1, -1, hit),
            mujoco.mj_ray(physics.model, physics.data, before, np.array([0.0, -1.0, 0.0]), groups, 1, -1, hit),
        ]
        seen.append((depth, geom_colours(physics.model)[int(hit[0])]))
    (first, grey), (second, brick) = seen
    assert np.allclose(first, second, atol=0.0015) and not np.allclose(first, second, atol=1e-6)
    assert brick[0] > 1.3 * brick[2] and abs(grey[0] - grey[2]) < 0.1


def test_lamps_of_its_own_replace_those_of_the_rooms() -> None:
    bare = load_scene("apartment")
    lamps = (Lamp(position=(0.0, 0.0, 2.5), colour=(1.0, 0.8, 0.6), brightness=0.5),)
    one = Physics(msgspec.structs.replace(bare, lamps=lamps, objects=()), 0).model
    assert one.nlight == 1 and np.allclose(one.light_diffuse[0], (0.5, 0.4, 0.3))
    assert Physics(msgspec.structs.replace(bare, objects=()), 0).model.nlight == len(bare.rooms)


def test_surroundings_are_drawn_from_the_seed() -> None:
    drawn = [surroundings(load_scene("apartment"), np.random.default_rng(s)) for s in range(12)]
    assert len({d.finish for d in drawn}) > 6 and len({d.lamps for d in drawn}) == 12
    assert surroundings(load_scene("apartment"), np.random.default_rng(5)) == drawn[5]
    for finish in GROUND:
        image = Image.open(io.BytesIO(picture(finish)))
        assert image.size == (256, 256) and np.asarray(image).std() > 2


# --- convex parts
def cup() -> tuple[np.ndarray, np.ndarray]:
    outline = [(0.0, 0.0), (0.04, 0.0), (0.04, 0.09), (0.034, 0.09), (0.034, 0.008), (0.0, 0.008)]
    shape = turned(list(pairwise(outline)), 0.0, 0.09, 0.0)
    sewn, index = np.unique(np.round(shape.vertices, 6), axis=0, return_inverse=True)
    return sewn, index.ravel()[shape.faces]


COACD = """
import pathlib, sys, time
def set_log_level(level): ...
def Mesh(vertices, faces): return vertices, faces
def run_coacd(mesh, **_):
    with open(pathlib.Path(__file__).with_name("asked"), "a") as asked:
        asked.write("x")
    {instead}
    return [mesh, (mesh[0] * 2, mesh[1])]
"""


@pytest.fixture
def decomposer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], Path]:
    """Puts a module in CoACD's place that makes two halves, or does something `instead`; a file counts its calls."""

    def put(instead: str = "") -> Path:
        folder = tmp_path / "package"
        folder.mkdir(exist_ok=True)
        (folder / "coacd.py").write_text(COACD.format(instead=instead))
        monkeypatch.syspath_prepend(str(folder))
        return folder / "asked"

    monkeypatch.setenv("TIDYBOT_CACHE_DIR", str(tmp_path / "cache"))
    return put


def open_inside(found: list[convex.Part]) -> bool:
    """Nothing is where a thumb goes: within 25 mm of the axis, from 15 mm above the ground."""
    x, y, z = np.meshgrid(np.linspace(-0.025, 0.025, 9), np.linspace(-0.025, 0.025, 9), np.linspace(0.023, 0.09, 9))
    room = np.stack([x, y, z], axis=-1)[np.hypot(x, y) < 0.025]
    return not any((Delaunay(corners).find_simplex(room) >= 0).any() for corners, _ in found)


def test_parts_are_made_once_and_a_torn_file_is_made_anew(decomposer: Callable[[str], Path], tmp_path: Path) -> None:
    asked = decomposer("")
    vertices, faces = cup()
    for _ in range(2):
        found = convex.parts(vertices, faces)
        assert len(found) == 2 and np.allclose(found[1][0], 2 * vertices) and np.array_equal(found[0][1], faces)
    assert asked.read_text() == "x"
    for file in (tmp_path / "cache" / "convex").iterdir():
        file.write_bytes(file.read_bytes()[:100])
    convex.parts(vertices, faces)
    assert asked.read_text() == "xx"


@pytest.mark.parametrize("instead", ["import os; os.abort()", "raise ValueError('not manifold')"])
def test_a_mesh_that_coacd_cannot_take_apart_is_cut_by_planes(
    instead: str, decomposer: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("TIDYBOT_CACHE_DIR", str(tmp_path / "file"))
    asked = decomposer(instead)
    found = convex.parts(*cup())
    assert asked.exists() and 4 < len(found) <= convex.MOST and open_inside(found)
    corners = np.concatenate([vertices for vertices, _ in found])
    assert np.allclose(np.ptp(corners, axis=0), (0.08, 0.08, 0.09), atol=1e-3)


def test_parts_that_were_cut_for_want_of_coacd_are_made_anew_with_it(
    decomposer: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch
) -> None:
    with monkeypatch.context() as without:
        without.setitem(sys.modules, "coacd", None)
        assert open_inside(convex.parts(*cup()))
    decomposer("")
    assert len(convex.parts(*cup())) == 2


def test_coacd_does_not_go_on_for_ever(
    decomposer: Callable[[str], Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    limited: list[tuple[int, tuple[int, int]]] = []
    decomposer("")
    monkeypatch.setattr(convex.resource, "setrlimit", lambda what, limits: limited.append((what, limits)))
    np.savez(tmp_path / "mesh.npz", v0=cup()[0], f0=cup()[1])
    assert convex.main(str(tmp_path / "mesh.npz"), str(tmp_path / "parts.npz")) == 0
    assert limited == [(convex.resource.RLIMIT_CPU, (convex.LIMIT, convex.LIMIT))]


def test_what_is_convex_stays_in_one_piece_and_a_sheet_gets_some_thickness() -> None:
    rod = turned(list(pairwise([(0.0, 0.0), (0.03, 0.0), (0.03, 0.2), (0.0, 0.2)])), 0.0, 0.2, 0.0)
    assert len(cells.parts(rod.vertices, rod.faces, 24)) == 1
    sheet = np.array([[0.0, 0, 0], [0.1, 0, 0], [0.1, 0.1, 0], [0, 0.1, 0]]), np.array([[0, 1, 2], [0, 2, 3]])
    ((corners, triangles),) = cells.parts(*sheet, 24)
    assert 0 < np.ptp(corners[:, 2]) < 0.001 and triangles.max() == len(corners) - 1


@pytest.mark.slow
def test_a_cup_keeps_its_inside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("coacd")
    monkeypatch.setenv("TIDYBOT_CACHE_DIR", str(tmp_path))
    found = convex.parts(*cup())
    assert len(found) > 5 and open_inside(found)


def test_the_seams_of_a_texture_are_sewn_before_a_mesh_is_taken_apart(decomposer: Callable[[str], Path]) -> None:
    decomposer("")
    corners, triangles = cup()
    loose = corners[triangles.ravel()]
    without_area = [[0, 0, 3]]
    faces = np.concatenate([np.arange(len(loose)).reshape(-1, 3), without_area])
    sewn, found = convex.parts(loose, faces)[0]
    assert len(sewn) == len(corners) and len(found) == len(triangles)


def test_a_mesh_whose_hull_would_fill_it_is_hollow() -> None:
    corners, triangles = cup()
    assert convex.hollow(corners, triangles)
    rod = turned(list(pairwise([(0.0, 0.0), (0.03, 0.0), (0.03, 0.2), (0.0, 0.2)])), 0.0, 0.2, 0.0)
    assert not convex.hollow(rod.vertices, rod.faces)


def test_a_hollow_mesh_that_is_seen_and_collides_is_taken_apart(
    decomposer: Callable[[str], Path], tmp_path: Path
) -> None:
    decomposer("")
    corners, triangles = cup()
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles]
    (tmp_path / "cup.obj").write_text("\n".join(lines))
    (tmp_path / "cup.xml").write_text(
        '<mujoco><asset><mesh name="cup" file="cup.obj" inertia="shell"/></asset><worldbody><body>'
        '<geom type="mesh" mesh="cup" mass="0.2"/></body></worldbody></mujoco>'
    )
    one = spec("cup", (0.08, 0.08, 0.09), model=str(tmp_path / "cup.xml"))
    assert body_of(one).geoms.count("hull_") == 2
