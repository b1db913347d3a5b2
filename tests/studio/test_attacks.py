"""A studio under attack: from a client that speaks its protocol, and from another page in a real browser."""

from __future__ import annotations

import asyncio
import http.client
import json
import time
import uuid
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

import pytest
from chromium import Browser
from studio_runtime import StudioRuntime

from motionrt import limits
from motionrt.studio import open_studio
from motionrt.studio.session import Show
from motionrt.studio.workshop import Workshop

SECRET = "CANARY-7f3a"


@pytest.fixture
def studio(viser: None) -> Iterator[Any]:
    page = open_studio(Show(), Workshop(StudioRuntime()), port=0)
    yield page
    page.stop()


def parts(page: Any) -> tuple[int, str]:
    address = urlsplit(page.url)
    return int(address.port or 0), address.query.removeprefix("token=")


def get(page: Any, path: str, **headers: str) -> tuple[int, bytes]:
    port, _ = parts(page)
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=20)
    connection.putrequest("GET", path, skip_host="Host" in headers)
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.read()


class Window:
    """A window without a browser: what the page's program sends and receives."""

    def __init__(self, page: Any, button: str = "Upload a mesh", **headers: str) -> None:
        self.port, self.token = parts(page)
        self.button = button
        self.headers = {"Cookie": f"motionrt-{self.port}={self.token}", **headers}
        self.received, self.component, self.transfer = b"", "", ""

    async def __aenter__(self) -> Window:  # noqa: PYI034
        import viser
        from websockets.asyncio.client import connect

        origin = self.headers.pop("Origin", f"http://127.0.0.1:{self.port}")
        self.socket = await connect(
            f"ws://127.0.0.1:{self.port}",
            subprotocols=[f"viser-v{viser.__version__}"],  # type: ignore[list-item]
            origin=origin or None,  # type: ignore[arg-type]
            additional_headers=self.headers,
            max_size=None,
            ping_interval=None,
        )
        await self.send(
            type="ViewerCameraMessage",
            wxyz=[1, 0, 0, 0],
            position=[0, 1, 3],
            fov=0.7,
            near=0.1,
            far=100.0,
            image_height=600,
            image_width=800,
            look_at=[0, 0, 0],
            up_direction=[0, 1, 0],
        )
        await self.hear(lambda: self.component)
        return self

    async def __aexit__(self, *_: object) -> None:
        await self.socket.close()

    async def send(self, **message: Any) -> None:
        import msgspec.msgpack

        await self.socket.send(msgspec.msgpack.encode(message))

    async def hear(self, enough: Any, seconds: float = 30) -> None:
        import msgspec.msgpack
        import zstandard

        end = time.monotonic() + seconds
        while not enough() and time.monotonic() < end:
            try:
                frame = await asyncio.wait_for(self.socket.recv(), 0.5)
            except asyncio.TimeoutError:
                continue
            assert isinstance(frame, bytes)
            packed = frame[16 : 16 + int.from_bytes(frame[8:16], "little")]
            content = zstandard.ZstdDecompressor().decompress(packed)
            self.received += content
            for message in msgspec.msgpack.decode(content)["messages"]:
                if message["type"] == "GuiUploadButtonMessage" and message["props"]["label"].startswith(self.button):
                    self.component = message["uuid"]
        assert enough(), self.received[-800:]

    async def upload(self, name: str, content: bytes, declared: int | None = None, count: int = 1) -> None:
        self.transfer = uuid.uuid4().hex
        await self.send(
            type="FileTransferStartUpload",
            source_component_uuid=self.component,
            transfer_uuid=self.transfer,
            filename=name,
            mime_type="text/plain",
            part_count=count,
            size_bytes=len(content) if declared is None else declared,
        )
        await self.part(0, content)

    async def part(self, index: int, content: bytes) -> None:
        await self.send(
            type="FileTransferPart",
            source_component_uuid=self.component,
            transfer_uuid=self.transfer,
            part_index=index,
            content=content,
        )


def test_the_address_has_a_token_and_nothing_is_served_without_it(studio: Any) -> None:
    port, token = parts(studio)
    assert len(token) >= 24
    assert get(studio, f"/?token={token}")[0] == 200
    assert get(studio, "/", Cookie=f"motionrt-{port}={token}")[0] == 200
    for path, headers in (("/", {}), ("/?token=", {}), ("/?token=wrong", {}), ("/", {"Cookie": f"motionrt-{port}=no"})):
        status, body = get(studio, path, **headers)
        assert status == 403
        assert b"<html" not in body


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1:1", "127.0.0.1.evil.example:{port}"]
)
def test_a_name_that_resolves_to_this_machine_is_refused(studio: Any, host: str) -> None:
    port, token = parts(studio)
    assert get(studio, f"/?token={token}", Host=host.format(port=port))[0] == 403
    assert get(studio, f"/?token={token}", Host=f"localhost:{port}")[0] == 200


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "", "https://127.0.0.1:{port}", "http://127.0.0.1:1"]
)
def test_another_page_cannot_connect_even_with_the_cookie(studio: Any, origin: str) -> None:
    from websockets.exceptions import InvalidStatus

    async def attack() -> None:
        async with Window(studio, Origin=origin.format(port=parts(studio)[0])):
            pass

    with pytest.raises(InvalidStatus, match="403"):
        asyncio.run(attack())


def test_a_socket_without_the_token_is_refused(studio: Any) -> None:
    from websockets.exceptions import InvalidStatus

    async def attack() -> None:
        async with Window(studio, Cookie="x=y"):
            pass

    with pytest.raises(InvalidStatus, match="403"):
        asyncio.run(attack())


def test_a_wish_to_share_the_page_opens_no_tunnel(studio: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    opened = []
    monkeypatch.setattr("viser._viser.ViserTunnel", lambda *a, **k: opened.append(a))

    async def attack() -> None:
        async with Window(studio) as window:
            await window.send(type="ShareUrlRequest")
            await window.upload("x.yaml", b"steps: [{wait: 1}]")
            await window.hear(lambda: b"Scene loaded" in window.received)  # so the wish before it was heard, too

    asyncio.run(attack())
    assert opened == []


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("s.yaml", "scene: {secret}\nsteps: [{{wait: 1}}]"),
        ("s.yaml", "scene: {{file: {secret}}}\nsteps: [{{wait: 1}}]"),
        ("s.yaml", "cloud: {secret}\nsteps: [{{wait: 1}}]"),
        ("s.yaml", "steps: [{{walk: {{path: {secret}}}}}]"),
        ("m.yaml", "image: {secret}\nresolution: 0.1"),
        ("m.yaml", "image: ../../../../../../../../{secret}\nresolution: 0.1"),
    ],
)
def test_an_upload_that_names_a_file_of_the_machine_learns_nothing(
    studio: Any, tmp_path: Path, name: str, content: str
) -> None:
    secret, missing = tmp_path / "here.csv", tmp_path / "gone.csv"
    secret.write_text(f"{SECRET},1\n", encoding="utf-8")
    told = []

    async def attack(file: Path) -> bytes:
        async with Window(studio) as window:
            await window.upload(name, content.format(secret=file).encode())
            await window.hear(lambda: b"did not work" in window.received)
            return window.received

    for file in (secret, missing):
        heard = asyncio.run(attack(file))
        assert SECRET.encode() not in heard
        assert b"not uploaded" in heard
        assert b"motionrt-" not in heard[heard.index(b"did not work") :]  # nor where uploads lie
        told.append(heard[heard.index(b"did not work") :][:250].replace(b"here", b"????").replace(b"gone", b"????"))
    assert told[0] == told[1]


@pytest.mark.parametrize(
    ("button", "name", "content"),
    [
        ("Open clips", "plan.yaml", "timeline: [{{text: walk, seconds: 2}}]\nedit: {secret}"),
        ("Open clips", "plan.yaml", "timeline: [{{text: walk, seconds: 2}}]\nkeep: {secret}\nclip: {secret}"),
        (
            "Open clips",
            "clip.gltf",
            '{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{secret}", "byteLength": 8}}]}}',
        ),
        (
            "Open a character",
            "me.gltf",
            '{{"asset": {{"version": "2.0"}}, "buffers": [{{"uri": "{secret}", "byteLength": 8}}]}}',
        ),
        ("Open a character", "me.glb", "{secret}"),
    ],
)
def test_clips_plans_and_characters_learn_nothing_of_the_machine_either(
    studio: Any, tmp_path: Path, button: str, name: str, content: str
) -> None:
    secret, missing = tmp_path / "here.csv", tmp_path / "gone.csv"
    secret.write_text(f"{SECRET},1\n", encoding="utf-8")
    told = []

    async def attack(file: Path) -> bytes:
        async with Window(studio, button) as window:
            before = len(window.received)
            await window.upload(name, content.format(secret=file).encode())
            await window.hear(lambda: b"did not work" in window.received[before:])
            return window.received[before:]

    for file in (secret, missing):
        heard = asyncio.run(attack(file))
        assert SECRET.encode() not in heard
        words = heard[heard.index(b"did not work") :].split(b"timestampSec")[0]
        told.append(words.replace(b"here", b"????").replace(b"gone", b"????"))
    assert told[0] == told[1]


def test_a_script_may_name_what_was_uploaded_before(studio: Any) -> None:
    async def use() -> None:
        async with Window(studio) as window:
            await window.upload("route.csv", b"0,0\n2,2\n")
            await window.hear(lambda: b"Uploaded" in window.received)
            await window.upload("s.yaml", b"steps: [{walk: {path: route.csv}}]")
            await window.hear(lambda: b"Scene loaded" in window.received)

    asyncio.run(use())


def test_uploads_are_counted_as_they_come_not_as_they_are_announced(studio: Any) -> None:
    from websockets.exceptions import ConnectionClosed

    sent = 0

    async def attack() -> None:
        nonlocal sent
        async with Window(studio) as window:
            await window.upload("x.obj", b"\0" * 1000, declared=10, count=1000)
            for sent in range(1, 1000):
                await window.part(sent, b"\0" * 2**20)
                await asyncio.sleep(0)

    most = limits.limits().upload_bytes
    with pytest.raises(ConnectionClosed):
        asyncio.run(attack())
    assert sent * 2**20 < most + 32 * 2**20  # what was on its way when the door was closed


def test_windows_beyond_the_limit_are_refused(studio: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    from websockets.exceptions import InvalidStatus

    monkeypatch.setenv("MOTIONRT_LIMITS", "windows=1")

    async def open_two() -> None:
        async with Window(studio), Window(studio):
            pass

    with pytest.raises(InvalidStatus, match="503"):
        asyncio.run(open_two())


def test_uploads_leave_nothing_on_the_disk(studio: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))

    async def use() -> None:
        async with Window(studio) as window:
            await window.upload("route.csv", b"0,0\n2,2\n")
            await window.hear(lambda: b"Uploaded" in window.received)
            assert len(list(tmp_path.iterdir())) == 1

    asyncio.run(use())
    end = time.monotonic() + 20
    while list(tmp_path.iterdir()) and time.monotonic() < end:
        time.sleep(0.1)
    assert list(tmp_path.iterdir()) == []


def test_another_page_of_the_same_browser_neither_connects_nor_frames_the_studio(
    studio: Any, chromium: Browser, tmp_path: Path
) -> None:
    own = chromium.open(studio.url, 600, 400, 0.3)  # so that the browser has the cookie
    own.wait_text("Search", 60)
    port, _ = parts(studio)
    (tmp_path / "evil.html").write_text("<p>evil</p>", encoding="utf-8")
    page = chromium.open((tmp_path / "evil.html").as_uri(), 600, 400, 0.3)
    page.wait_text("evil")
    script = (
        f"new Promise(done => {{ const s = new WebSocket('ws://127.0.0.1:{port}', {json.dumps(_protocol())});"
        " s.onopen = () => done('open'); s.onerror = () => done('refused'); })"
    )
    assert page.run(script) == "refused"
    assert own.run(script) == "open"
    read = f"fetch('http://127.0.0.1:{port}/').then(a => a.text()).then(t => 'read ' + t.length, () => 'refused')"
    assert page.run(read) == "refused"


def _protocol() -> str:
    import viser

    return f"viser-v{viser.__version__}"
