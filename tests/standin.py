"""A stand-in for MuJoCo Menagerie's stanford_tidybot: its bodies with meshes to look at, as its file has them.

Defaults by class, files for meshes, visual meshes before collision meshes, rotated ones, materials, a site on another
body than the gripper's. Frames, joints, masses and limits are those of our own model.
"""

import xml.etree.ElementTree as ET
from pathlib import Path

from services.sim import robot
from services.sim.skin import MERGED, THEIRS

ASKEW = ((0.23, 0.22, -0.03), (-0.24, 0.22, -0.03), (-0.24, -0.23, -0.03), (0.23, 0.1, 0.03), (-0.24, 0.0, 0.03))
"""Corners [m] of a bumper whose principal axes are not those of its sides."""


def _meshes(folder: Path) -> None:
    """The files that the model names, as STL: corners are not shared, axes are not principal."""
    import trimesh  # not for everybody who collects the tests to load

    folder.mkdir(parents=True, exist_ok=True)
    rod = trimesh.creation.cylinder(0.03, 0.12, sections=24)
    rod.apply_transform(trimesh.transformations.rotation_matrix(0.7, (1, 2, 3), (0, 0, 0)))
    made = {"bumper": trimesh.convex.convex_hull(ASKEW), "rod": rod}
    made["shell"] = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
    for name, mesh in made.items():
        mesh.export(folder / f"{name}.stl")


def write(root: Path, without: str = "", file: str = "tidybot.xml") -> Path:
    """The model below a MENAGERIE_ROOT; the body named `without` has nothing to look at."""
    folder = root / "stanford_tidybot"
    _meshes(folder / "assets")
    model = ET.parse(robot.MODEL).getroot()
    asset, default, compiler = model.find("asset"), model.find("default"), model.find("compiler")
    assert asset is not None and default is not None and compiler is not None
    compiler.set("meshdir", "assets")
    ET.SubElement(asset, "material", name="grey", rgba="0.6 0.6 0.6 1")
    for name in ("rod", "shell", "bumper"):
        ET.SubElement(asset, "mesh", name=f"{name}_look", file=f"{name}.stl")
    see = ET.SubElement(default, "default", {"class": "see"})
    ET.SubElement(see, "geom", type="mesh", contype="0", conaffinity="0", group="2", mass="0")
    looks = {"base": ("bumper", "0 0 0.04", "1 0 0 0"), "half_arm_2_link": ("rod", "0 0 -0.1", "0.3 0.6 0.1 0.7")}
    for body in model.iter("body"):
        name = str(body.get("name"))
        mesh, pos, quat = looks.get(name, ("shell", "0 0 0", "0.5 0.1 0.7 0.2"))
        body.set("name", THEIRS.get(name, name))
        if name != without:
            first = next(n for n, child in enumerate(body) if child.tag == "geom")
            look = {"class": "see", "mesh": f"{mesh}_look", "pos": pos, "quat": quat, "material": "grey"}
            body.insert(first, ET.Element("geom", look))
    for theirs, ours in MERGED.items():
        pad = next(b for b in model.iter("body") if b.get("name") == ours)
        silicone = ET.SubElement(pad, "body", name=theirs)
        ET.SubElement(silicone, "geom", {"class": "see", "mesh": "shell_look"})
    for exclude in model.iter("exclude"):
        for end in ("body1", "body2"):
            exclude.set(end, THEIRS.get(str(exclude.get(end)), str(exclude.get(end))))
    (folder / file).write_text(ET.tostring(model, encoding="unicode"))
    (folder / "scene.xml").write_text('<mujoco><include file="tidybot.xml"/></mujoco>')
    return root
