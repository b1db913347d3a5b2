"""The HTTP service as its clients meet it: over a socket of the loopback address."""

from __future__ import annotations

import concurrent.futures
import http.client
import json
import threading
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from motions import walking
from service import TOKEN, Served

from motionrt import limits, load_motion
from motionrt.runtime import Runtime

HEADERS = {"Authorization": f"Bearer {TOKEN}"}


def ask(
    served: Served, method: str, path: str, body: object = None, headers: dict[str, str] | None = None
) -> tuple[int, bytes, dict[str, str]]:
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=60)
    content = body if isinstance(body, bytes) or body is None else json.dumps(body).encode()
    sent = {"Content-Type": "application/json"} | (HEADERS if headers is None else headers)
    connection.request(method, path, content, sent)
    answer = connection.getresponse()
    result = answer.status, answer.read(), {name.lower(): value for name, value in answer.getheaders()}
    connection.close()
    return result


def told(answer: tuple[int, bytes, dict[str, str]], status: int = 200) -> Any:
    assert answer[0] == status, answer[1]
    return json.loads(answer[1])


def test_hits_are_those_of_the_runtime(served: Served, runtime: Runtime, library: Path) -> None:
    found = told(ask(served, "POST", "/v1/retrieve", {"text": "walks", "k": 3, "gallery": "own"}))
    expected = runtime.retrieve("walks", 3, library)
    assert [(hit["clip"], hit["start_s"]) for hit in found["hits"]] == [(hit.id, hit.start_s) for hit in expected]
    np.testing.assert_allclose([hit["score"] for hit in found["hits"]], [hit.score for hit in expected], atol=1e-6)
    assert "path" not in found["hits"][0]


def test_filters_and_notices_come_through(served: Served) -> None:
    tagged = told(ask(served, "POST", "/v1/retrieve", {"text": "walks", "tags": ["sci-fi"], "anyway": True}))
    assert [hit["clip"] for hit in tagged["hits"]] == ["long.npz"]
    words = told(ask(served, "POST", "/v1/retrieve", {"text": "walks", "words": "dancing robots", "anyway": True}))
    assert [hit["clip"] for hit in words["hits"]] == ["long.npz"]
    short = told(ask(served, "POST", "/v1/retrieve", {"text": "walks", "max_s": 5, "where": "abs(turn) > 1"}))
    assert {hit["clip"] for hit in short["hits"]} <= {"walk.bvh", "ä/kreis.bvh"}
    assert told(ask(served, "POST", "/v1/retrieve", {"text": "walks", "folder": "no"}))["notice"]


def test_similar_leaves_the_clip_itself_out(served: Served) -> None:
    hits = told(ask(served, "POST", "/v1/similar", {"clip": "walk.bvh"}))["hits"]
    assert {hit["clip"] for hit in hits} == {"ä/kreis.bvh", "long.npz"}


def test_a_clip_comes_as_a_file_cut_to_its_span(served: Served, tmp_path: Path) -> None:
    status, content, headers = ask(served, "GET", "/v1/motion?clip=long.npz&start_s=1&end_s=3&format=npz")
    assert (status, headers["x-motion-frames"]) == (200, "40")
    (tmp_path / "part.npz").write_bytes(content)
    assert load_motion(tmp_path / "part.npz").duration == pytest.approx(2.0)


@pytest.mark.parametrize("form", ["glb", "bvh", "npz"])
def test_a_text_becomes_a_motion_and_a_seed_the_same(served: Served, tmp_path: Path, form: str) -> None:
    asked = {"text": "walk", "seconds": 1.0, "seed": 3, "format": form}
    answers = [ask(served, "POST", "/v1/generate", asked)[1] for _ in range(2)]
    assert answers[0] == answers[1]
    (tmp_path / f"made.{form}").write_bytes(answers[0])
    assert load_motion(tmp_path / f"made.{form}").duration == pytest.approx(1.0, abs=0.05)


def test_layers_of_texts_and_clips_are_composed(served: Served, tmp_path: Path) -> None:
    layers = [{"clip": "walk.bvh"}, {"text": "wave the right hand", "parts": ["right arm"]}]
    status, content, _ = ask(served, "POST", "/v1/compose", {"layers": layers, "seed": 1, "format": "npz"})
    assert status == 200
    (tmp_path / "both.npz").write_bytes(content)
    assert load_motion(tmp_path / "both.npz").frames > 10


def test_a_text_that_is_the_name_of_a_file_opens_no_file(served: Served, library: Path) -> None:
    for text in (str(library / "walk.bvh"), "/etc/passwd.bvh"):
        status, content, _ = ask(
            served, "POST", "/v1/compose", {"layers": [{"text": text}, {"text": "wave"}], "seed": 1}
        )
        assert status == 200 or json.loads(content)["error"]["type"] == "InvalidInputError"
    assert told(ask(served, "POST", "/v1/similar", {"clip": str(library / "walk.bvh")}), 422)
    assert told(ask(served, "GET", "/v1/motion?clip=../walk.bvh"), 422)["error"]["type"] == "InvalidInputError"


def test_files_are_described_and_converted(served: Served, library: Path, tmp_path: Path, runtime: Runtime) -> None:
    content = (library / "walk.bvh").read_bytes()
    captions = told(ask(served, "POST", "/v1/describe?name=walk.bvh&k=2", content))
    assert [one["text"] for one in captions] == [one.text for one in runtime.describe(library / "walk.bvh", 2)]
    status, made, _ = ask(served, "POST", "/v1/convert?name=walk.bvh&format=npz&fps=10", content)
    assert status == 200
    (tmp_path / "made.npz").write_bytes(made)
    assert load_motion(tmp_path / "made.npz").fps == 10


@pytest.mark.parametrize(
    ("method", "path", "body", "status", "kind"),
    [
        ("POST", "/v1/retrieve", {"text": ""}, 422, "InvalidInputError"),
        ("POST", "/v1/retrieve", {"text": "walk", "where": "turn >"}, 422, "InvalidInputError"),
        ("POST", "/v1/retrieve", {"text": "walk", "gallery": "other"}, 404, "GalleryNotFoundError"),
        ("GET", "/v1/motion?clip=none", None, 422, "InvalidInputError"),
        ("POST", "/v1/generate", {"text": "walk", "seconds": 0.01}, 422, "InvalidInputError"),
        ("POST", "/v1/convert?name=walk.bvh&format=npz", b"HIERARCHY nothing", 422, "FormatError"),
        ("POST", "/v1/convert?name=walk.exe&format=npz", b"x", 422, None),
        ("POST", "/v1/compose", {"layers": [{"text": "walk"}, {}]}, 422, "InvalidInputError"),
    ],
)
def test_mistakes_are_told_with_their_kind_and_no_path_of_the_server(
    served: Served, library: Path, method: str, path: str, body: object, status: int, kind: str | None
) -> None:
    error = told(ask(served, method, path, body), status)["error"]
    assert error["type"] == kind or kind is None
    assert error["message"]
    assert "/tmp" not in error["message"]
    assert str(library) not in error["message"]


def test_fields_that_are_not_known_are_refused(served: Served) -> None:
    answer = ask(served, "POST", "/v1/retrieve", {"text": "walk", "galery": "own"})
    assert "galery" in told(answer, 422)["error"]["message"]


@pytest.mark.parametrize("headers", [{}, {"Authorization": "Bearer wrong"}, {"Authorization": TOKEN}])
@pytest.mark.parametrize("path", ["/v1/galleries", "/metrics", "/openapi.json", "/v1/nothing"])
def test_without_the_token_nothing_is_served(served: Served, headers: dict[str, str], path: str) -> None:
    assert told(ask(served, "GET", path, headers=headers), 401)["error"]["type"] == "Unauthorized"


def test_other_web_pages_may_not_ask(served: Served) -> None:
    assert ask(served, "GET", "/v1/galleries", headers={**HEADERS, "Origin": "https://evil.example"})[0] == 403
    assert ask(served, "GET", "/v1/galleries", headers={**HEADERS, "Origin": "https://studio.example"})[0] == 200


def test_health_needs_no_token(served: Served) -> None:
    assert told(ask(served, "GET", "/health", headers={}))["status"] == "ok"


def test_openapi_describes_every_verb(served: Served) -> None:
    paths = told(ask(served, "GET", "/openapi.json"))["paths"]
    verbs = {"retrieve", "similar", "motion", "describe", "generate", "compose", "convert", "galleries"}
    assert {f"/v1/{verb}" for verb in verbs} <= set(paths)


def test_bodies_beyond_the_limit_are_refused_whether_they_say_their_length_or_not(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MOTIONRT_LIMITS", "upload_bytes=1000")
    path = "/v1/convert?name=a.bvh&format=npz"
    assert told(ask(served, "POST", path, b"x" * 1001), 413)["error"]["type"] == "TooLargeError"
    connection = http.client.HTTPConnection("127.0.0.1", served.port, timeout=60)
    connection.request("POST", path, iter([b"x" * 600, b"x" * 600]), HEADERS, encode_chunked=True)
    answer = connection.getresponse()
    assert answer.status == 413
    assert "upload_bytes" in answer.read().decode()
    connection.close()
    assert limits.limits().upload_bytes == 1000


def test_too_many_requests_at_once_are_told_to_come_back(served: Served, monkeypatch: pytest.MonkeyPatch) -> None:
    going = threading.Event()

    def slow(*_: object, **__: object) -> None:
        going.wait(20)
        raise ValueError("over")

    monkeypatch.setattr(Runtime, "generate", slow)
    with concurrent.futures.ThreadPoolExecutor(9) as pool:
        waiting = [pool.submit(ask, served, "POST", "/v1/generate", {"text": "walk"}) for _ in range(4)]
        deadline = time.monotonic() + 15
        while served.app._metrics.active < 4 and time.monotonic() < deadline:  # type: ignore[attr-defined]
            time.sleep(0.02)
        status, _, headers = ask(served, "GET", "/v1/galleries")
        assert (status, headers["retry-after"]) == (503, "1")
        going.set()
        assert {answer.result()[0] for answer in waiting} == {500}  # a mistake of ours, and no word about it
    assert ask(served, "GET", "/v1/galleries")[0] == 200


def test_metrics_count_requests_and_failures(served: Served) -> None:
    def count(status: int) -> int:
        lines = ask(served, "GET", "/metrics")[1].decode().splitlines()
        wanted = f'motionrt_requests_total{{route="/v1/retrieve",status="{status}"}} '
        return next((int(line.removeprefix(wanted)) for line in lines if line.startswith(wanted)), 0)

    before = count(200), count(422)
    ask(served, "POST", "/v1/retrieve", {"text": "walk"})
    ask(served, "POST", "/v1/retrieve", {"text": ""})
    assert (count(200), count(422)) == (before[0] + 1, before[1] + 1)


def test_many_clients_get_the_answers_of_one(served: Served) -> None:
    texts = [f"walks {n}" for n in range(12)]
    alone = [told(ask(served, "POST", "/v1/retrieve", {"text": text, "anyway": True})) for text in texts]

    def asking(text: str) -> Any:
        while True:
            answer = ask(served, "POST", "/v1/retrieve", {"text": text, "anyway": True})
            if answer[0] != 503:
                return told(answer)
            time.sleep(0.05)

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        assert list(pool.map(asking, texts)) == alone


def test_a_file_that_names_others_gets_none_of_them(served: Served, tmp_path: Path) -> None:
    walking(5).save(tmp_path / "a.gltf")
    document = json.loads((tmp_path / "a.gltf").read_text())
    document["buffers"][0]["uri"] = "/etc/hostname"
    error = told(ask(served, "POST", "/v1/convert?name=a.gltf&format=npz", json.dumps(document).encode()), 422)["error"]
    assert "another file" in error["message"]
