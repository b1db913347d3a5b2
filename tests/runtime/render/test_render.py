"""Pictures and animations: what is in the files, not how they look."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from gaits import gait

from motionrt import Motion, Skeleton, load_motion
from motionrt.errors import InvalidInputError, MissingDependencyError, MotionFileNotFoundError, MotionRTError
from motionrt.rendering import Look, Mark, Take, picture, render
from motionrt.rendering.files import gif_rate
from motionrt.rendering.poses import side_by_side

image = pytest.importorskip("PIL.Image", reason="Pillow, of the extra render, is not installed")
LEFT, RIGHT = "#00ff00", "#ff00ff"
SPOTS = {"left": "#ff0000", "right": "#ff0000", "mark": "#00ffff", "thing": "#00ffff", "path": "#0000ff"}
PLAIN: dict[str, Any] = {"grid": False, "shadow": False, "times": False, "colours": {"left": LEFT, "right": RIGHT}}


@pytest.fixture(scope="module")
def walk() -> Motion:
    return gait(seconds=1.5)[0]


def _columns(drawn: Any, channel_high: tuple[int, ...], channel_low: tuple[int, ...]) -> np.ndarray:
    """Columns with pixels that shine in some channels and not in others."""
    pixels = np.asarray(drawn, int)
    hit = (pixels[..., channel_high].min(-1) > 110) & (pixels[..., channel_low].max(-1) < 90)
    return np.flatnonzero(hit.any(axis=0))


def _groups(columns: np.ndarray, gap: int = 3) -> int:
    return 1 + int((np.diff(columns) > gap).sum()) if len(columns) else 0


def test_a_strip_has_as_many_figures_as_poses(walk: Motion) -> None:
    drawn = picture(walk, Look(poses=5, camera="front", **PLAIN))
    assert drawn.size[0] == 1600
    assert _groups(_columns(drawn, (1,), (0, 2))) == 5


def test_from_the_front_the_left_limbs_are_on_the_right_and_from_behind_on_the_left(walk: Motion) -> None:
    for camera, sign in (("front", 1), ("back", -1)):
        drawn = picture(walk, Look(poses=1, camera=camera, size=(300, 300), **PLAIN))
        green, violet = _columns(drawn, (1,), (0, 2)).mean(), _columns(drawn, (0, 2), (1,)).mean()
        assert sign * (green - violet) > 5


def test_a_picture_has_the_size_that_was_asked_for(walk: Motion, tmp_path: Path) -> None:
    for layout in ("strip", "path"):
        path = render([walk, walk], tmp_path / "x.png", layout=layout, size=(640, 480), captions=["a", "b"], columns=2)
        with image.open(path) as drawn:
            assert (drawn.size, drawn.mode) == ((640, 480), "RGB")


def test_every_pixel_outside_the_figures_is_background(walk: Motion) -> None:
    drawn = np.asarray(picture(walk, Look(theme="dark", **PLAIN)))
    assert (drawn[0] == (0x16, 0x1B, 0x22)).all()


def test_a_gif_plays_as_long_as_the_motion_and_repeats(walk: Motion, tmp_path: Path) -> None:
    with image.open(render(walk, tmp_path / "x.gif", size=(120, 120), fps=60)) as film:
        assert film.info["loop"] == 0
        total = 0
        for frame in range(film.n_frames):
            film.seek(frame)
            total += film.info["duration"]
    assert total == pytest.approx(1000 * walk.duration, abs=40)


@pytest.mark.parametrize(("fps", "played"), [(60, 25), (30, 25), (25, 25), (24, 25), (20, 20), (15, 100 / 7), (1, 1)])
def test_gif_rates_are_whole_hundredths_of_a_second(fps: float, played: float) -> None:
    assert gif_rate(fps) == pytest.approx(played)


def test_a_gif_keeps_the_background_exact_and_moves(walk: Motion, tmp_path: Path) -> None:
    with image.open(render(walk, tmp_path / "x.gif", size=(120, 120), follow=False)) as film:
        first = np.asarray(film.convert("RGB"), int)
        film.seek(film.n_frames // 2)
        later = np.asarray(film.convert("RGB"), int)
    assert (first[0, 0] == 255).all()
    assert np.abs(first - later).max() > 100


def test_a_clip_that_is_over_waits_for_the_longer_one(walk: Motion, tmp_path: Path) -> None:
    path = render([walk, walk[:10]], tmp_path / "x.gif", size=(200, 100), times=False)
    with image.open(path) as film:
        film.seek(film.n_frames // 2)
        middle = np.asarray(film.convert("RGB"), int)
        film.seek(film.n_frames - 1)
        last = np.asarray(film.convert("RGB"), int)
    assert np.abs(middle - last)[:, :100].max() > 60
    assert np.abs(middle - last)[:, 100:].max() == 0


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="the program ffmpeg is not installed")
def test_an_mp4_is_a_video_of_the_length_of_the_motion(walk: Motion, tmp_path: Path) -> None:
    path = render(walk, tmp_path / "x.mp4", size=(121, 121), fps=30)
    said = subprocess.run(["ffmpeg", "-i", str(path)], capture_output=True, check=False).stderr.decode()
    assert "Duration: 00:00:01.50" in said
    assert "120x120" in said
    assert "30 fps" in said
    assert path.read_bytes().find(b"moov") < path.read_bytes().find(b"mdat")  # plays before all of it is there


def test_without_ffmpeg_an_mp4_is_an_error_that_says_what_to_install(
    walk: Motion, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(MissingDependencyError, match="install ffmpeg"):
        render(walk, tmp_path / "x.mp4")
    assert not list(tmp_path.iterdir())


@pytest.mark.skipif(sys.platform == "win32", reason="the false ffmpeg is a shell script")
def test_what_ffmpeg_complains_of_is_told(walk: Motion, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho 'no such encoder' >&2\nexit 1\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(InvalidInputError, match="no such encoder"):
        render(walk, tmp_path / "x.mp4", size=(400, 400))
    assert [path.name for path in tmp_path.iterdir()] == ["ffmpeg"]


def test_without_pillow_there_is_an_error_that_says_what_to_install(walk: Motion, tmp_path: Path) -> None:
    code = (
        "import sys; sys.modules['PIL'] = None\n"
        "from motionrt import render, SMPL24, Motion; import numpy as np\n"
        "motion = Motion(np.tile(np.eye(3), (2, 24, 1, 1)), np.zeros((2, 3)), 30)\n"
        "try: render(motion, 'x.png')\n"
        "except ImportError as error: print(type(error).__name__, error)"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True, cwd=tmp_path).stdout.decode()
    assert said.startswith("MissingDependencyError")
    assert 'pip install "motionrt[render]"' in said


def test_marks_paths_and_things_are_drawn(walk: Motion) -> None:
    plain = {"camera": "front", "layout": "path", "times": False, "poses": 2, "size": (400, 300)}
    look = Look(**plain, grid=False, shadow=False, colours=SPOTS)
    take = Take(walk, paths=[np.array([[-1, 0], [-1, 2.0]])], marks=[Mark((1.0, 1.0, 0.0))])
    assert len(_columns(picture(take, look), (1, 2), (0,)))
    assert len(_columns(picture(take, look), (2,), (0, 1)))
    gone = Take(walk, marks=[Mark((1.0, 1.0, 0.0), start_s=99.0)])
    assert not len(_columns(picture(gone, look), (1, 2), (0,)))
    assert len(_columns(picture(Take(walk, things=np.array([[1.0, 0.5, 0.0]])), look), (1, 2), (0,)))


def test_performances_and_walks_are_drawn_with_what_belongs_to_them(walk: Motion) -> None:
    path = SimpleNamespace(points=np.array([[0, 0], [0, 2]], np.float32))
    segment = SimpleNamespace(keypoints={"left_hand": (1.2, 1.0, 0.4)}, start=0, end=45)
    performed = SimpleNamespace(motion=walk, segments=[segment], paths=[path])
    look = Look(layout="path", grid=False, shadow=False, colours=SPOTS)
    assert len(_columns(picture(performed, look), (1, 2), (0,)))
    assert len(_columns(picture(SimpleNamespace(motion=walk, path=path), look), (2,), (0, 1)))


def test_files_are_drawn_and_their_names_are_captions(walk: Motion, tmp_path: Path) -> None:
    path = walk.save(tmp_path / "a walk.bvh")
    drawn = np.asarray(picture(path, Look()), int)
    bare = np.asarray(picture(load_motion(path), Look()), int)
    assert drawn.shape[0] > bare.shape[0]
    with pytest.raises(MotionFileNotFoundError):
        picture(tmp_path / "none.bvh")


def test_other_skeletons_are_drawn_bone_by_bone() -> None:
    skeleton = Skeleton(("hip", "left_tip", "right_tip"), (-1, 0, 0), np.array([[0, 0, 0], [0.5, 0, 0], [-0.5, 0, 0]]))
    motion = Motion(np.tile(np.eye(3), (3, 3, 1, 1)), np.tile([0, 1.0, 0], (3, 1)), 30, skeleton)
    drawn = picture(motion, Look(poses=1, camera="front", **PLAIN))
    assert _columns(drawn, (1,), (0, 2)).mean() > _columns(drawn, (0, 2), (1,)).mean()


def test_one_frame_is_a_picture_and_an_animation(walk: Motion, tmp_path: Path) -> None:
    for name in ("x.png", "x.gif", "x.jpg", "x.webp"):
        with image.open(render(walk[:1], tmp_path / name, size=(128, 128), layout="path")) as drawn:
            assert drawn.size == (128, 128)


def test_long_captions_are_cut_and_strange_letters_do_no_harm(walk: Motion) -> None:
    for words in ("ein sehr langer Titel, der nicht passt " * 5, "走る\n\tzwei Zeilen 🕺"):
        drawn = np.asarray(picture(walk, Look(size=(300, 200), **PLAIN), words), int)
        assert (drawn[:20, -3:] == 255).all()
        assert (drawn[:20] < 128).any()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"camera": "up"}, "three-quarter"),
        ({"elevation": 120}, "elevation"),
        ({"layout": "round"}, "strip"),
        ({"poses": 0}, "poses"),
        ({"size": (10, 10)}, "size"),
        ({"size": (10**6, 100)}, "size"),
        ({"columns": 0}, "columns"),
        ({"fps": 0}, "fps"),
        ({"fps": float("nan")}, "fps"),
        ({"theme": "pink"}, "light"),
        ({"colours": {"nose": "#ffffff"}}, "left"),
        ({"colours": {"left": "red"}}, "#3d8bd4"),
        ({"captions": ["a", "b"]}, "caption"),
    ],
)
def test_what_cannot_be_drawn_so_is_a_typed_error(walk: Motion, tmp_path: Path, options: Any, words: str) -> None:
    with pytest.raises(InvalidInputError, match=words):
        render(walk, tmp_path / "x.png", **options)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("given", [[], 7, [None]])
def test_what_is_no_motion_is_a_typed_error(given: Any, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError):
        render(given, tmp_path / "x.png")


def test_unknown_suffixes_and_folders_that_are_not_there_are_typed_errors(walk: Motion, tmp_path: Path) -> None:
    with pytest.raises(InvalidInputError, match=r"\.gif"):
        render(walk, tmp_path / "x.tiff")
    with pytest.raises(MotionRTError, match="cannot write"):
        render(walk, tmp_path / "none" / "x.png", size=(100, 100))


def test_moments_are_the_poses_of_a_picture(walk: Motion) -> None:
    take = Take(walk, moments=[(0.0, "first"), (0.5, ""), (99.0, "last")])
    for layout in ("strip", "path"):
        assert side_by_side(take, Look(layout=layout)).frames.tolist() == [0, 15, walk.frames - 1]
    drawn = picture(take, Look(camera="front", **PLAIN))
    assert _groups(_columns(drawn, (1,), (0, 2)), gap=60) == 3


def test_a_strip_that_follows_turns_with_the_character() -> None:
    """Somebody who turns by 180 degrees shows the other side to the world, but not to who goes round with them."""
    turns = np.tile(np.eye(3, dtype=np.float32), (2, 24, 1, 1))
    turns[1, 0] = np.diag([-1, 1, -1])
    turning = Motion(turns, np.tile(np.float32([0, 0.95, 0]), (2, 1)), 2)
    for follow, sides in ((False, [1, -1]), (True, [1, 1])):
        drawn = np.asarray(picture(turning, Look(camera="front", follow=follow, size=(800, 300), **PLAIN)))
        halves = [drawn[:, :400], drawn[:, 400:]]
        found = [np.sign(_columns(h, (1,), (0, 2)).mean() - _columns(h, (0, 2), (1,)).mean()) for h in halves]
        assert found == sides


def test_trails_lead_from_pose_to_pose(walk: Motion) -> None:
    bare, trailed = (np.asarray(picture(walk, Look(poses=3, trails=on, **PLAIN)), int) for on in (False, True))
    changed = np.flatnonzero((np.abs(bare - trailed) > 20).any(axis=(0, 2)))
    assert np.ptp(changed) > 500
