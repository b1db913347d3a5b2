"""The page: a viser server, a session for every window, and an end."""

from __future__ import annotations

import contextlib
import io
import socket
import threading
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from motionrt.errors import InvalidInputError
from motionrt.studio.bodies import figure_box
from motionrt.studio.gate import Gate, serving_through
from motionrt.studio.layout import AS_RECORDED, frame_all, offsets
from motionrt.studio.session import ASPECT, FIELD_OF_VIEW, PANEL_PIXELS, Session, scenery_boxes
from motionrt.studio.state import Kept
from motionrt.studio.windows import Show

if TYPE_CHECKING:
    from motionrt.studio.workshop import Workshop

HOST, PORT = "127.0.0.1", 8080
NEAR = 0.1  # metres; nearer planes make marks on the ground flicker
GROUND, HORIZON, SKY = (226, 229, 234), (240, 242, 245), (208, 219, 233)
FOG_NEAR, FOG_FAR = 16.0, 55.0  # metres
_starting = threading.Lock()  # one server is started at a time
MakeSession = Callable[[Any, Show], Session]


class Page:
    """A page that is being served.

    Args:
        server: of viser.
        url: where it is, with the token that lets a browser in.
        make: what a new window gets.
        show: what it begins with.
        browser_of: which browser a window of a number belongs to.
    """

    def __init__(
        self,
        server: Any,
        url: str,
        make: MakeSession,
        show: Show,
        browser_of: Callable[[int], str | None] = lambda _: None,
    ) -> None:
        self.server, self.url, self.show = server, url, show
        self._browser_of, self._kept = browser_of, Kept()
        self._make = make
        self.sessions: dict[int, Session] = {}
        self._stopped = threading.Event()
        server.on_client_connect(self._opened)
        server.on_client_disconnect(self._closed)

    def wait(self, seconds: float | None = None) -> bool:
        """Until the page is stopped, or some seconds; whether it is stopped."""
        return self._stopped.wait(seconds)

    def stop(self) -> None:
        """End all windows and the server."""
        if self._stopped.is_set():
            return
        self._stopped.set()
        for session in list(self.sessions.values()):
            session.close()
        with contextlib.redirect_stdout(io.StringIO()):  # viser says so
            self.server.stop()

    def _opened(self, client: Any) -> None:
        session = self._make(client, self.show)
        self.sessions[client.client_id] = session
        state = self._kept.take(self._browser_of(client.client_id))
        if state is not None:
            session.take_up(state)
        threading.Thread(target=session.run, daemon=True, name=f"window {client.client_id}").start()

    def _closed(self, client: Any) -> None:
        session = self.sessions.pop(client.client_id, None)
        if session is not None:
            self._kept.keep(self._browser_of(client.client_id), session.state())
            session.close()


def open_viewer(show: Show, *, host: str = HOST, port: int = PORT) -> Page:
    """Serve clips to look at.

    Args:
        show: what to show.
        host: an address of this machine; 127.0.0.1 is for this machine alone, 0.0.0.0 for everybody.
        port: 0 takes a free one.

    Raises:
        InvalidInputError: viser is not installed, or the port is taken.
    """
    return serve(Session, show, host=host, port=port, title="motionrt view")


def open_studio(show: Show, workshop: Workshop, *, host: str = HOST, port: int = PORT) -> Page:
    """Serve the studio; arguments and errors as for :func:`open_viewer`.

    Args:
        show: what to begin with.
        workshop: models, gallery and folder.
        host: an address of this machine.
        port: 0 takes a free one.
    """
    from motionrt.studio.studio_session import StudioSession

    workshop.open_ahead()

    def make(client: Any, begin: Show) -> Session:
        return StudioSession(client, begin, workshop)

    return serve(make, show, host=host, port=port, title="motionrt studio")


def serve(make: MakeSession, show: Show, *, host: str, port: int, title: str) -> Page:
    """Open a server whose windows are made by ``make``."""
    viser = _viser()
    gate = Gate(host, free_port(host, port))
    server = _guarded_server(viser, gate, title)
    _furnish(server)
    _aim(server, show)
    return Page(server, gate.url, make, show, gate.browser_of)


def _guarded_server(viser: Any, gate: Gate, title: str) -> Any:
    """A server of viser with the gate in front: viser has no place for one, so it is put where the port is opened.

    Raises:
        InvalidInputError: this version of viser opens its port in another way; nothing is served then.
    """
    import websockets.asyncio.server as sockets

    with _starting, contextlib.redirect_stdout(io.StringIO()):  # viser prints a box
        serve = sockets.serve
        sockets.serve = serving_through(gate, serve)  # type: ignore[misc,assignment]
        try:
            server = viser.ViserServer(host=gate.host, port=gate.port, label=title, verbose=False)
        finally:
            sockets.serve = serve  # type: ignore[misc]
        if not gate.installed or server.get_port() != gate.port:
            server.stop()
            raise InvalidInputError(
                "this version of viser cannot be guarded, so nothing is served; install another: pip install "
                "'motionrt[studio]'"
            )
    return server


def free_port(host: str, port: int) -> int:
    """The port, if nobody listens there; for 0 any that is free.

    Raises:
        InvalidInputError: it is taken, or the address is none of this machine.
    """
    if not 0 <= port < 65536:
        raise InvalidInputError(f"a port is 0 to 65535, not {port}")
    try:
        found = socket.getaddrinfo(host or None, port, type=socket.SOCK_STREAM, flags=socket.AI_PASSIVE)[0]
        with socket.socket(found[0], socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind(found[4])
            return int(probe.getsockname()[1])
    except OSError as error:
        raise InvalidInputError(
            f"cannot serve on {host}:{port}: {error.strerror or error}; choose another port with --port (0 takes a "
            "free one) or another address with --host"
        ) from error


def _viser() -> Any:
    try:
        import viser
    except ImportError as error:
        raise InvalidInputError('the viewer needs the package viser: pip install "motionrt[studio]"') from error
    return viser


def _furnish(server: Any) -> None:
    """Ground, light and theme, the same for all windows."""
    scene = server.scene
    scene.set_up_direction("+y")
    scene.world_axes.visible = False
    scene.configure_default_lights(enabled=False)
    scene.configure_environment_map("studio", environment_intensity=0.22)
    scene.add_light_hemisphere("/light/sky", sky_color=(255, 252, 246), ground_color=(188, 192, 204), intensity=0.55)
    scene.add_light_directional(
        "/light/sun", color=(255, 246, 232), intensity=1.15, cast_shadow=True, position=(2, 5, 3)
    )
    scene.configure_fog(FOG_NEAR, FOG_FAR, color=HORIZON)
    scene.set_background_image(_sky(), format="png")
    scene.add_grid(
        "/ground",
        plane="xz",
        infinite_grid=True,
        cell_size=0.25,
        cell_color=(214, 217, 223),
        cell_thickness=0.6,
        section_size=1.0,
        section_color=(186, 191, 200),
        section_thickness=1.0,
        fade_distance=45.0,
        fade_strength=1.5,
        shadow_opacity=0.28,
        plane_color=GROUND,
        plane_opacity=1.0,
    )
    server.gui.configure_theme(
        control_width="medium", show_logo=False, show_share_button=False, brand_color=(62, 104, 178)
    )


def _sky() -> Any:
    """A picture of a clear sky above the horizon."""
    import numpy as np

    share = np.clip(np.linspace(1.3, -0.6, 256), 0, 1)[:, None, None]
    return np.broadcast_to((share * SKY + (1 - share) * HORIZON), (256, 4, 3)).astype(np.uint8)


def _aim(server: Any, show: Show) -> None:
    """Where cameras begin, and where "reset view" leads."""
    boxes = [figure_box(clip) for clip in show.clips]
    moves = offsets(boxes, [clip.motion.root[0] for clip in show.clips], show.layout or AS_RECORDED)
    placed = [box + move for box, move in zip(boxes, moves, strict=True)]
    place, target = frame_all([*placed, *scenery_boxes(show.scenery)], FIELD_OF_VIEW, ASPECT, PANEL_PIXELS / 1280)
    server.initial_camera.fov, server.initial_camera.near = FIELD_OF_VIEW, NEAR
    server.initial_camera.position, server.initial_camera.look_at = place, target
