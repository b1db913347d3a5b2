"""The road by a language model: the prompt, answers of all shapes, and an endpoint served by the test."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, HTTPServer, ThreadingHTTPServer

import pytest
from hypothesis import given
from hypothesis import strategies as st

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import ARMS, LEGS, PARTS
from motionrt.synthesis.parts import Endpoint, LabellingError, PromptLabeller, parts_in_answer, prompt_for


@pytest.mark.parametrize(
    ("answer", "expected"),
    [
        ("right arm", {"right arm"}),
        ("Left Leg, RIGHT LEG, Buttocks.", {*LEGS, "global"}),
        ("- left arm\n- right arm\n- neck\n", {*ARMS, "torso"}),
        ("1) torso; 2) waist", {"torso", "global"}),
        ("**Right hand** and both feet", {"right arm", *LEGS}),
        ("left and right arms", set(ARMS)),
        ("left_arm, right_leg", {"left arm", "right leg"}),
        ('["head", "hips"]', {"torso", "global"}),
        ("knees", set(LEGS)),
        ("The left elbow moves, not the right arm.", {"left arm"}),
        ("Answer: upper body", {"torso"}),
        ("None.", set()),
        ("right arm\n\nAction: walk\nParts: left leg", {"right arm"}),
    ],
)
def test_answers_are_understood(answer: str, expected: set[str]) -> None:
    assert parts_in_answer(answer) == expected


@pytest.mark.parametrize("answer", ["", "I cannot help with that", "42", "the tail"])
def test_an_answer_without_parts_is_an_error_that_quotes_it(answer: str) -> None:
    with pytest.raises(LabellingError) as caught:
        parts_in_answer(answer)
    assert repr(answer) in str(caught.value)


@given(st.sets(st.sampled_from(PARTS), min_size=1), st.sampled_from([", ", "\n", "; ", " and ", "\n- "]))
def test_any_list_of_parts_comes_back(expected: set[str], joint: str) -> None:
    assert parts_in_answer(joint.join(sorted(expected))) == expected


def test_the_prompt_has_instruction_list_examples_and_ends_with_the_action() -> None:
    prompt = prompt_for("juggle\nthree balls")
    assert "- left arm" in prompt
    assert "- buttocks" in prompt
    assert prompt.count("Action:") >= 4
    assert prompt.endswith("Action: juggle three balls\nParts:")


def test_any_callable_labels() -> None:
    prompts: list[str] = []

    def complete(prompt: str) -> str:
        prompts.append(prompt)
        return "Left arm, neck"

    assert PromptLabeller(complete)("scratch the head") == {"left arm", "torso"}
    assert len(prompts) == 1
    assert "scratch the head" in prompts[0]


def test_a_callable_that_answers_no_text_is_an_error() -> None:
    with pytest.raises(LabellingError, match="must answer with text"):
        PromptLabeller(lambda prompt: ["left arm"])("wave")  # type: ignore[arg-type,return-value]


def test_a_model_is_needed_and_only_one() -> None:
    with pytest.raises(InvalidInputError, match="needs a language model"):
        PromptLabeller()
    with pytest.raises(InvalidInputError, match="needs a language model"):
        PromptLabeller(lambda prompt: "torso", endpoint=Endpoint("http://localhost/v1", "m"))
    with pytest.raises(InvalidInputError, match="callable"):
        PromptLabeller("gpt")  # type: ignore[arg-type]


class _Model(BaseHTTPRequestHandler):
    """Answers as the server's ``reply`` says, and keeps what it was asked."""

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers["Content-Length"]))
        self.server.asked = (self.path, self.headers["Authorization"], json.loads(body))  # type: ignore[attr-defined]
        status, reply = self.server.reply  # type: ignore[attr-defined]
        self.send_response(status)
        self.end_headers()
        self.wfile.write(reply)

    def log_message(self, *args: object) -> None:
        pass


@pytest.fixture
def server() -> Iterator[HTTPServer]:
    server = HTTPServer(("127.0.0.1", 0), _Model)
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    yield server
    server.shutdown()
    server.server_close()


def _endpoint(server: HTTPServer) -> Endpoint:
    return Endpoint(f"http://127.0.0.1:{server.server_address[1]}/v1/", "small-model", "secret-key", timeout_s=5)


def _completion(content: object) -> bytes:
    return json.dumps({"choices": [{"message": {"role": "assistant", "content": content}}]}).encode()


def test_an_endpoint_is_asked_as_a_chat_completion(server: HTTPServer) -> None:
    server.reply = 200, _completion("left leg, right leg, waist")  # type: ignore[attr-defined]
    assert PromptLabeller(endpoint=_endpoint(server))("march") == {*LEGS, "global"}
    path, key, body = server.asked  # type: ignore[attr-defined]
    assert (path, key, body["model"]) == ("/v1/chat/completions", "Bearer secret-key", "small-model")
    assert body["messages"][0]["content"].endswith("Action: march\nParts:")


@pytest.mark.parametrize(
    ("reply", "message"),
    [
        ((401, b"no such key"), "401.*no such key"),
        ((200, b"<html>"), "did not answer as a chat completion"),
        ((200, b'{"choices": []}'), "did not answer as a chat completion"),
        ((200, b"[" * 100_000), "did not answer as a chat completion"),
        ((200, b" " * 3_000_000), "longer than"),
        ((200, _completion(None)), "without text"),
        ((200, _completion("as you wish")), "as you wish"),
    ],
)
def test_a_wrong_reply_is_a_labelling_error(server: HTTPServer, reply: tuple[int, bytes], message: str) -> None:
    server.reply = reply  # type: ignore[attr-defined]
    with pytest.raises(LabellingError, match=message) as caught:
        PromptLabeller(endpoint=_endpoint(server))("march")
    assert "secret-key" not in str(caught.value)


def test_nobody_listening_is_a_labelling_error(server: HTTPServer) -> None:
    endpoint = _endpoint(server)
    server.shutdown()
    server.server_close()
    with pytest.raises(LabellingError, match="gave no answer"):
        endpoint("hello")


@pytest.mark.parametrize(
    ("url", "model", "timeout"),
    [
        ("file:///etc/passwd", "m", 1.0),
        ("localhost:8000", "m", 1.0),
        ("http://host/v1", "", 1.0),
        ("http://h", "m", 0.0),
        ("http://h", "m", float("inf")),
        ("http://h", "m", float("nan")),
    ],
)
def test_an_endpoint_says_what_is_wrong_with_it(url: str, model: str, timeout: float) -> None:
    with pytest.raises(InvalidInputError, match=r"endpoint|timeout"):
        Endpoint(url, model, timeout_s=timeout)


def test_the_key_is_not_shown() -> None:
    assert "secret" not in repr(Endpoint("http://host/v1", "m", "secret"))


@pytest.mark.parametrize("key", ["two\nlines", "snow ☃", "a b"])
def test_a_key_that_no_header_can_hold_is_refused_and_not_shown(key: str) -> None:
    with pytest.raises(InvalidInputError, match="API key") as caught:
        Endpoint("http://host/v1", "m", key)
    assert key not in str(caught.value)


def test_what_a_model_of_the_caller_raises_comes_out_as_it_is() -> None:
    fire = OSError("GPU on fire")

    def ask(prompt: str) -> str:
        raise fire

    with pytest.raises(OSError, match="GPU on fire") as caught:
        PromptLabeller(ask)("march")
    assert caught.value is fire


def test_only_the_beginning_of_an_endless_answer_is_read() -> None:
    assert parts_in_answer("torso. " + "blah " * 200_000 + "left arm") == {"torso"}


class _Dripping(BaseHTTPRequestHandler):
    """A byte now and then, for ever: no single wait is long."""

    def do_POST(self) -> None:
        self.send_response(self.server.status)  # type: ignore[attr-defined]
        self.end_headers()
        with suppress(OSError):
            while not self.server.done.wait(0.02):  # type: ignore[attr-defined]
                self.wfile.write(b" ")

    def log_message(self, *args: object) -> None:
        pass


def test_an_answer_that_never_ends_is_given_up() -> None:
    with ThreadingHTTPServer(("127.0.0.1", 0), _Dripping) as server:
        server.status, server.done = 200, threading.Event()  # type: ignore[attr-defined]
        threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
        with pytest.raises(LabellingError, match="did not end in time"):
            Endpoint(f"http://127.0.0.1:{server.server_address[1]}/v1", "m", timeout_s=0.3)("march")
        server.done.set()  # type: ignore[attr-defined]
        server.shutdown()


def test_the_three_prompts_of_the_paper_are_open_a_list_and_a_list_with_examples() -> None:
    free, listed, examples = (prompt_for("nod  twice", style) for style in ("free", "list", "examples"))
    assert all("nod twice" in prompt for prompt in (free, listed, examples))
    assert "- torso" not in free
    assert "- torso" in listed
    assert "wave with the right hand" not in listed
    assert "wave with the right hand" in examples
    assert prompt_for("nod  twice") == examples
    asked = []
    labeller = PromptLabeller(lambda prompt: asked.append(prompt) or "The torso, and the neck.", style="free")
    assert labeller("nod  twice") == {"torso"}
    assert asked == [free]
    with pytest.raises(InvalidInputError, match="no style of prompt 'essay'"):
        PromptLabeller(lambda _: "", style="essay")
