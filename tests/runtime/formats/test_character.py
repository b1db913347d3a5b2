"""Characters with a mesh: vertices stand where the glTF specification puts them, and colours are those of the file."""

from __future__ import annotations

import importlib.util
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from characters import character
from glb_files import Glb, Player, glb
from motions import walking

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats import load_character
from motionrt.limits import raised
from motionrt.rigs.skin import fewer_colours

ROOT = Path(__file__).parents[3]
TURN = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])


def skinned(player: Player, made: Glb, frame: int) -> np.ndarray:
    """The vertices of the helper's mesh by matrices of four by four."""
    attributes = made.document["meshes"][0]["primitives"][0]["attributes"]
    points = player.numbers(attributes["POSITION"])
    binds = np.swapaxes(player.numbers(made.document["skins"][0]["inverseBindMatrices"]).reshape(-1, 4, 4), 1, 2)
    worlds = player.matrices(frame)
    out = []
    for number, point in enumerate(points):
        joint = number // 3
        out.append((worlds[made.document["nodes"][joint]["name"]] @ binds[joint] @ [*point, 1])[:3])
    return np.array(out)


@pytest.mark.parametrize(
    ("frames", "armature", "unit", "posed"),
    [
        ("bone", None, 1.0, None),
        ("random", (TURN, 0.01), 1.0, None),
        ("world", None, 0.01, None),
        ("bone", None, 1.0, {9: np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])}),
    ],
)
def test_vertices_stand_where_the_saved_file_puts_them(
    tmp_path: Path, frames: str, armature: tuple[np.ndarray, float] | None, unit: float, posed: dict[int, np.ndarray]
) -> None:
    made = glb(character("mixamo", thigh=0.3, shank=0.3), frames=frames, armature=armature, unit=unit, posed=posed)
    hero = load_character(made.save(tmp_path / "hero.glb"))
    motion = walking(20)
    moved = hero.retargeted(motion)
    player = Player(moved.save(tmp_path / "moved.glb"))
    dressed = hero.dressed(motion)
    for frame in (0, 7, 19):
        theirs = skinned(player, made, frame) / moved.units_per_metre
        assert dressed.vertices(frame) == pytest.approx(theirs, abs=2e-4)


def test_a_character_is_as_tall_as_the_figure_and_stands_where_it_stands(tmp_path: Path) -> None:
    small = character("unreal", thigh=0.2, shank=0.2, ankle=0.05, foot=0.07, sole=0.01)
    hero = load_character(glb(small).save(tmp_path / "small.glb"))
    motion = walking(40)
    dressed = hero.dressed(motion)
    pelvis = hero.rig.clip.names.index("pelvis")
    assert dressed.places[:, pelvis, [0, 2]] == pytest.approx(motion.root[:, [0, 2]], abs=0.05)
    assert -0.02 < dressed.vertices(20)[:, 1].min() < 0.12


def test_colours_are_those_of_the_material(tmp_path: Path) -> None:
    made = glb(character("mixamo"))
    made.document["materials"][0]["pbrMetallicRoughness"] = {"baseColorFactor": [1.0, 0.0, 0.2140411, 1.0]}
    colours = load_character(made.save(tmp_path / "red.glb")).skin.colours
    assert np.abs(colours.astype(int) - [255, 0, 127]).max() <= 2  # factors are linear


def test_colours_are_those_of_the_texture_in_the_middle_of_a_triangle(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image", reason="textures need Pillow, which is not installed")
    made = glb(character("mixamo"))
    picture = image.new("RGB", (2, 1), (200, 30, 10))
    picture.putpixel((1, 0), (10, 60, 220))
    content = BytesIO()
    picture.save(content, "PNG")
    made.binary += b"\0" * (-len(made.binary) % 4)
    view = {"buffer": 0, "byteOffset": len(made.binary), "byteLength": len(content.getvalue())}
    made.binary += content.getvalue()
    made.document["bufferViews"].append(view)
    made.document["images"] = [{"bufferView": len(made.document["bufferViews"]) - 1, "mimeType": "image/png"}]
    made.document["textures"] = [{"source": 0}]
    made.document["materials"][0]["pbrMetallicRoughness"] = {"baseColorTexture": {"index": 0}}
    part = made.document["meshes"][0]["primitives"][0]
    corners = np.zeros((made.document["accessors"][part["attributes"]["POSITION"]]["count"], 2), np.float32)
    corners[3:, 0] = 0.75  # the first triangle lies in the left half
    part["attributes"]["TEXCOORD_0"] = made.array(corners, "VEC2")
    colours = load_character(made.save(tmp_path / "two.glb")).skin.colours
    assert colours[0].tolist() == [200, 30, 10]
    assert colours[1].tolist() == [10, 60, 220]


def test_many_pictures_that_unpack_to_more_than_their_bytes_say_stay_packed(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image", reason="textures need Pillow, which is not installed")
    made, painted = glb(character("mixamo")), {}
    for side in (1500, 1501, 1502):
        picture = BytesIO()
        image.new("RGB", (side, side), (200, 30, 10)).save(picture, "PNG")
        packed = np.frombuffer(picture.getvalue(), np.uint8)
        made.array(packed, "SCALAR")
        painted[side] = len(made.document["bufferViews"]) - 1
    made.document["images"] = [{"bufferView": view} for view in painted.values()]
    made.document["textures"] = [{"source": number} for number in range(3)]
    part = made.document["meshes"][0]["primitives"][0]
    count = made.document["accessors"][part["attributes"]["POSITION"]]["count"]
    part["attributes"]["TEXCOORD_0"] = made.array(np.full((count, 2), 0.3, np.float32), "VEC2")
    made.document["materials"] = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": n}}} for n in range(3)]
    made.document["meshes"][0]["primitives"] = [{**part, "material": number} for number in range(3)]
    file = made.save(tmp_path / "bomb.glb")
    with raised(pixels=5_000_000):  # two of them
        colours = load_character(file).skin.colours.reshape(3, -1, 3)
    assert [tuple(part[0].tolist()) == (200, 30, 10) for part in colours] == [True, True, False]
    assert (load_character(file).skin.colours == (200, 30, 10)).all()


def test_a_mesh_without_a_skin_moves_with_the_joint_that_it_hangs_on(tmp_path: Path) -> None:
    made = glb(character("mixamo"))
    head = next(i for i, node in enumerate(made.document["nodes"]) if node["name"] == "mixamorig:Head")
    hat = {"POSITION": made.array(np.array([[0, 0.3, 0], [0.1, 0.3, 0], [0, 0.3, 0.1]], np.float32), "VEC3")}
    made.document["meshes"].append({"primitives": [{"attributes": hat}]})
    made.document["nodes"].append({"name": "Hat", "mesh": 1, "translation": [0, 0.1, 0]})
    made.document["nodes"][head].setdefault("children", []).append(len(made.document["nodes"]) - 1)
    hero = load_character(made.save(tmp_path / "hat.glb"))
    dressed = hero.dressed(walking(20))
    joint = hero.rig.clip.names.index("mixamorig:Head")
    distances = [np.linalg.norm(dressed.vertices(f)[-3] - dressed.places[f, joint]) for f in (0, 10, 19)]
    assert distances == pytest.approx([distances[0]] * 3, abs=1e-5)
    assert distances[0] == pytest.approx(0.4 * np.linalg.norm(dressed.skin.local[-3, 0]) / 0.4, abs=1e-5)


def test_files_that_are_no_characters_say_what_to_do(tmp_path: Path) -> None:
    bare = glb(character("mixamo"))
    bare.document["meshes"][0]["primitives"][0]["mode"] = 0
    with pytest.raises(FormatError, match="no mesh on its skeleton: export the character"):
        load_character(bare.save(tmp_path / "bare.glb"))
    packed = glb(character("mixamo"))
    packed.document["meshes"][0]["primitives"][0]["extensions"] = {"KHR_draco_mesh_compression": {}}
    with pytest.raises(FormatError, match="export without compression"):
        load_character(packed.save(tmp_path / "packed.glb"))
    broken = glb(character("mixamo"))
    part = broken.document["meshes"][0]["primitives"][0]
    part["indices"] = broken.array(np.array([0, 1, 60000], np.uint16), "SCALAR")
    with pytest.raises(FormatError, match="damaged"):
        load_character(broken.save(tmp_path / "broken.glb"))
    with pytest.raises(InvalidInputError, match="File > Export > glTF"):
        load_character(tmp_path / "walk.bvh")


def test_fewer_colours_keep_what_is_common_and_what_stands_out() -> None:
    colours = np.repeat(np.array([[200, 180, 150], [202, 181, 149], [20, 20, 25], [250, 0, 0]], np.uint8), 50, axis=0)
    few = fewer_colours(colours, 3)
    assert len(np.unique(few, axis=0)) == 3
    assert np.abs(few.astype(int) - colours).max() <= 3


@pytest.mark.skipif(not (ROOT / "examples").is_dir(), reason="the examples are not part of this distribution")
def test_the_robot_of_the_examples_is_what_its_program_makes() -> None:
    spec = importlib.util.spec_from_file_location("make_robot", ROOT / "examples" / "make_robot.py")
    assert spec is not None
    assert spec.loader is not None
    program = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(program)
    assert program.robot() == (ROOT / "examples" / "robot.glb").read_bytes()
    dressed = load_character(ROOT / "examples" / "robot.glb").dressed(walking(10))
    assert len(np.unique(dressed.skin.colours, axis=0)) == 5
    assert np.ptp(dressed.vertices(5)[:, 1]) == pytest.approx(2.6, abs=0.4)  # a large head on legs as long as ours
