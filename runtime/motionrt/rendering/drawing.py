"""``render`` and ``picture``: motions into pictures and animations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from motionrt.formats import Character
from motionrt.rendering.files import FILMS, PICTURES, gif_rate, write_gif, write_mp4, write_picture
from motionrt.rendering.film import film
from motionrt.rendering.look import Layout, Look
from motionrt.rendering.pillow import ffmpeg, pillow
from motionrt.rendering.places import places
from motionrt.rendering.strip import filmstrip
from motionrt.rendering.takes import TakeLike, takes_of
from motionrt.untrusted.outputs import checked_output

GIF_FPS, VIDEO_FPS = 20.0, 30.0


def render(
    given: TakeLike | Sequence[TakeLike],
    out: str | Path,
    *,
    captions: str | Sequence[str] | None = None,
    camera: str | float | None = None,
    elevation: float | None = None,
    follow: bool | None = None,
    layout: Layout = "strip",
    poses: int | None = None,
    size: tuple[int, int] | None = None,
    columns: int | None = None,
    fps: float | None = None,
    theme: str = "light",
    colours: Mapping[str, str] | None = None,
    grid: bool = True,
    shadow: bool = True,
    times: bool = True,
    trails: bool = False,
    character: Character | str | Path | None = None,
) -> Path:
    """Draw motions: a picture (.png, .jpg, .webp) or an animation (.gif, .mp4), as the suffix of the file says.

    The left limbs are blue, the right ones red, and a visor says where the character looks. Needs the extra ``render``
    (Pillow), and for .mp4 the program ffmpeg.

    Args:
        given: a motion, its file, a ``Performance`` or a ``Walk`` (with paths and keypoints), a
            :class:`~motionrt.rendering.Take`, or several of them, which are drawn side by side.
        out: the file to write.
        captions: a line above each; by default the names of files.
        camera: ``"front"``, ``"three-quarter"`` (the default), ``"side"``, ``"back"``, ``"left"`` or ``"top"``, as the
            character is seen in its first frame; or degrees from its front to its right.
        elevation: degrees that the eye is above the horizon; by default what suits the camera.
        follow: animations: the camera goes along; by default it does where the character leaves its place. In strips:
            every pose is seen from the same side of the character; by default from the same side of the world.
        layout: pictures: ``"strip"``, poses side by side, or ``"path"``, poses where they happen.
        poses: pictures: how many; by default 10 in a strip, and one about every 0.9 m of a path.
        size: pixels (width, height), height 0 for what is needed; by default 1600 wide for pictures, and 400 by 400
            for each clip of an animation.
        columns: how many clips stand side by side; by default 1 in pictures, up to 3 in animations.
        fps: animations: frames per second, by default 20 for a .gif and 30 for an .mp4; a .gif has 25 at most, the
            rate that every program plays as it is. Speed is that of the motion whatever the rate.
        theme: ``"light"`` or ``"dark"``.
        colours: changes of the theme, as in ``{"left": "#00aa55"}``; names of
            :class:`~motionrt.rendering.Colours`.
        grid: draw the floor.
        shadow: draw shadows.
        times: write seconds.
        trails: draw the ways of wrists and ankles.
        character: who is drawn instead of the figure: your own (``.glb``, ``.gltf``, ``.vrm``) with its mesh, in the
            colours of its materials and textures, as tall as the figure.

    Returns:
        The path of the file, which is whole or not there.

    Raises:
        MissingDependencyError: Pillow or ffmpeg is not installed; the message says how to install it.
        InvalidInputError: an unknown suffix, nothing to draw, anything out of range, or the file cannot be written.
        MotionFileNotFoundError, FormatError, RigError: a motion file that cannot be read.
    """
    look = Look(
        camera, elevation, follow, layout, poses, size, columns, fps, theme, colours, grid, shadow, times, trails
    )  # fmt: skip
    return render_as(given, out, look, captions, character)


def render_as(
    given: TakeLike | Sequence[TakeLike],
    out: str | Path,
    look: Look,
    captions: str | Sequence[str] | None = None,
    character: Character | str | Path | None = None,
) -> Path:
    """As :func:`render`, with all that can be chosen in one value."""
    path = checked_output(out, (*PICTURES, *FILMS), "drawn")
    suffix = path.suffix.lower()
    if suffix in PICTURES:
        return write_picture(picture(given, look, captions, character), path)
    pillow("Image")
    if suffix == ".mp4":
        ffmpeg()
    takes = takes_of(given, captions, character)
    rate = gif_rate(look.fps or GIF_FPS) if suffix == ".gif" else look.fps or VIDEO_FPS
    images = film(takes, look, rate)
    return write_gif(images, path, rate, look.palette) if suffix == ".gif" else write_mp4(images, path, rate)


def picture(
    given: TakeLike | Sequence[TakeLike],
    look: Look | None = None,
    captions: str | Sequence[str] | None = None,
    character: Character | str | Path | None = None,
) -> Any:
    """The picture that :func:`render` writes, as a ``PIL.Image``, for notebooks; errors as there."""
    pillow("Image")
    chosen = Look() if look is None else look
    takes = takes_of(given, captions, character)
    return filmstrip(takes, chosen) if chosen.layout == "strip" else places(takes, chosen)
