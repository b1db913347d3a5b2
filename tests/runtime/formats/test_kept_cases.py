"""Files as people have them, rebuilt from public bug reports: ../shared/cases/files, each with its EXPECT.txt.

Motions are compared with the forward kinematics that comes with the cases, which shares no code with motionrt.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any

import pytest
from shell import shell_environment

from motionrt import load_motion
from motionrt.cli import main
from motionrt.errors import FormatError, MotionFileWarning

CASES = Path(__file__).resolve().parents[4] / "shared" / "cases" / "files"
pytestmark = pytest.mark.skipif(not CASES.is_dir(), reason=f"needs the kept cases in {CASES}")

_FILES = {
    "01_six_channels": "walk6.bvh",
    "02_mixed_channels": "mixed.bvh",
    "03_zero_offsets": "zero.bvh",
    "04_frame_count": "declared_one_more.bvh",
    "05_encodings": "bom_crlf.bvh cr_only.bvh sjis_names.bvh utf16.bvh nul_padding.bvh",
    "06_numbers": "sci.bvh tabs_blank_lines.bvh comma.bvh",
    "07_names": "mixamorig1.bvh spaces.bvh vroid.bvh mmd_japanese.bvh auto_rig_pro.bvh rigify.bvh"
    " xsens_mvn.bvh numbers_only.bvh",
    "10_z_up": "zup.bvh inches.bvh",
    "11_root": "reference_root.bvh reference_carries_travel.bvh",
    "13_five_toes": "makehuman_toes.bvh",
    "14_named_markers": "markers.bvh",
    "15_sides_by_structure": "numbers_legs_right_first.bvh",
    "16_suffix": "avatar_walk.vrm scene.gltf embedded.gltf",
    "17_glb_variants": "quantised_int16.glb cubicspline.glb sparse.glb",
    "18_armature_travels": "armature_object_travels.glb",
    "20_ik_feet": "ik_feet.glb",
    "21_smpl_files": "amass_smplh.npz amass_new_key.npz stageii_smplx.npz stageii_with_poses165.npz"
    " smpl72.npz motionx_322_body159.npz poses_3d_array.npz",
}
MOTIONS = [f"{folder}/{name}" for folder, names in _FILES.items() for name in names.split()]


def verify(motion: Any) -> bool:
    """Whether limbs, vertical, size, frames, rate and travel are those of the base."""
    base = str(CASES / "_base")
    if base not in sys.path:
        sys.path.insert(0, base)
    import lib

    return bool(lib.verify(motion))


def read(name: str, **options: Any) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", MotionFileWarning)
        return load_motion(CASES / name, **options)


@pytest.mark.parametrize("name", MOTIONS)
def test_a_kept_file_reads_as_the_motion_that_it_was_made_of(name: str) -> None:
    assert verify(read(name))


_RATELESS = {
    "09_frame_time": "milliseconds.bvh no_header.bvh stamped_24.bvh zero.bvh",
    "21_smpl_files": "no_rate.npz rate_in_bytes.npz",
    "22_video_capture": "gvhmr_global.npz y_up_in_amass_layout.npz",
}
RATELESS = [f"{folder}/{name}" for folder, names in _RATELESS.items() for name in names.split()]


@pytest.mark.parametrize("name", RATELESS)
def test_a_kept_file_reads_at_the_rate_of_the_caller(name: str) -> None:
    assert verify(read(name, fps=30))


def test_an_interrupted_export_keeps_its_whole_frames() -> None:
    with pytest.warns(MotionFileWarning, match=r"90.*89"):
        assert load_motion(CASES / "04_frame_count" / "cut_in_last_line.bvh").frames == 89


@pytest.mark.parametrize("name", ["rot_only.bvh"])
def test_without_positions_a_figure_stays_on_the_spot(name: str) -> None:
    motion = read(f"11_root/{name}")
    assert motion.frames == 90
    assert float(abs(motion.root[:, [0, 2]]).max()) < 0.05


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("06_numbers/nan_gap.bvh", ":154:"),
        ("08_two_roots/duo.bvh", ":142: a second ROOT"),
        ("23_text_to_motion/results.npy", "pickled"),
    ],
)
def test_what_cannot_be_read_is_said_with_its_place(name: str, words: str) -> None:
    with pytest.raises(FormatError, match=words):
        read(name)


@pytest.mark.parametrize("name", ["new_joint_vecs_263.npy", "new_joints_22x3.npy"])
def test_results_of_text_to_motion_convert(name: str, tmp_path: Path) -> None:
    assert main(["convert", str(CASES / "23_text_to_motion" / name), str(tmp_path / "o.bvh")]) == 0
    assert load_motion(tmp_path / "o.bvh").fps == pytest.approx(20, rel=1e-3)


MAPS = "ros1 ros2_025 negate negate_true alpha palette deep16 onebit la relative dotslash"


@pytest.mark.parametrize("name", MAPS.split())
def test_all_shades_of_a_map_give_the_same_way_round_the_wall(name: str) -> None:
    from motionrt.locomotion.scene import Scene

    pytest.importorskip("PIL", reason='needs the extra scene: pip install "motionrt[scene]"')
    scene = Scene.from_map(CASES / "24_nav2_maps" / f"{name}.yaml")
    path = scene.plan((2.0, -1.0), (8.0, -1.0))
    assert path.length == pytest.approx(10.3, abs=0.25)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("tabs", "tabs.yaml:3:"), ("walk_list", "walk_list.yaml:3:"), ("xyz", "xyz.yaml:3:"), ("typo", "typo.yaml:2:"),
        ("typo2", "typo2.yaml:3:"), ("yes_no", "yes_no.yaml:1:"), ("negspeed", "negspeed.yaml:1:"),
        ("utf16", "utf16.yaml:1:"), ("unreachable", "no plausible pose|cm apart|outside"), ("too_far", "cm|outside"),
    ],
)  # fmt: skip
def test_a_mistake_in_a_script_is_named(
    name: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    import re

    assert main(["perform", str(CASES / "27_scripts" / f"{name}.yaml"), "-o", str(tmp_path / "o.bvh")]) == 1
    assert re.search(words, capsys.readouterr().err)


@pytest.mark.parametrize("text", ["歩く", "🙂", "ein Mann geht"])
def test_a_text_without_a_known_word_says_so(text: str, capsys: pytest.CaptureFixture[str]) -> None:
    main(["retrieve", text, "-k", "1"])
    assert "no word of the query is known" in capsys.readouterr().err


ABOVE = {"24_nav2_maps", "27_scripts", "29_foreign_text"}  # checked above, in one process
SCRIPTS = sorted({path.parent.name for path in CASES.glob("*/run.sh")} - ABOVE)
SAID = {  # scripts whose exit code says something else than their words: how often they say what is wanted
    "23_text_to_motion": ("pickled objects", 1),
    "28_euler_flips": ("flips 0\n", 3),
}


@pytest.mark.skipif(shutil.which("bash") is None, reason="the cases' own scripts want bash")
@pytest.mark.parametrize("name", SCRIPTS)
def test_the_script_of_a_kept_case_is_content(name: str, tmp_path: Path) -> None:
    """What EXPECT.txt says, as the case itself checks it, in a copy of its folder."""
    for folder in (name, "_base"):
        shutil.copytree(CASES / folder, tmp_path / folder)
    command = ["bash", str(tmp_path / name / "run.sh")]
    done = subprocess.run(command, env=shell_environment(tmp_path), capture_output=True, text=True, check=False)
    said = done.stdout + done.stderr
    words, count = SAID.get(name, ("", 0))
    assert said.count(words) == count if words else done.returncode == 0, said
