"""Sentences of the kind that users type, for the ranges of the sentence encoder's activations."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

SENTENCES: tuple[str, ...] = (
    "a person walks forward",
    "walk in a circle",
    "someone is walking backwards slowly and then stops",
    "a man walks forward, turns around to the left and walks back",
    "the person runs at full speed across the room",
    "jogging in place",
    "a woman jumps up and down on both feet, three times in a row",
    "hops on the left leg",
    "he leaps over an obstacle and lands with bent knees",
    "long jump from a standing start",
    "a person sits down on a chair, waits a moment, then stands up again",
    "crouching low to the ground while sneaking forward",
    "kneels down on the right knee and ties a shoe",
    "she lies down on her back and rolls over onto her stomach",
    "crawling on hands and knees",
    "climbs up three steps of a ladder",
    "walking up the stairs holding the rail",
    "steps down from a platform",
    "a person waves hello with the right hand",
    "waving both arms above the head to get attention",
    "claps hands twice",
    "points at something far away with an outstretched arm",
    "throws a ball overhand as far as possible",
    "catches a ball with both hands and passes it on",
    "a basketball player dribbles, then shoots",
    "kicks a soccer ball with the right foot",
    "swings a golf club",
    "a tennis serve followed by a backhand",
    "boxing: two quick jabs and a hook",
    "side kick with the left leg, martial arts style",
    "blocks a punch and steps back",
    "sword fighting, a thrust and a parry",
    "dances the salsa with small steps and turning hips",
    "ballet pirouette on one foot with raised arms",
    "a slow waltz with an imaginary partner",
    "break dance moves on the floor",
    "cartwheel to the side",
    "does a handstand against the wall",
    "forward roll on a mat",
    "stretching: the trunk bends to the left and then to the right",
    "touches the toes with straight legs",
    "rotates the shoulders and loosens the neck",
    "doing squats with the arms held out in front of the body",
    "push-ups",
    "sit ups with hands behind the head",
    "jumping jacks",
    "picks up a heavy box from the floor and puts it on a high shelf",
    "carries something in the left hand while walking",
    "pushes a cart forward with effort",
    "pulls a rope hand over hand",
    "sweeps the floor with a broom",
    "washes a window in large circular motions",
    "opens a door, goes through and closes it behind him",
    "drinks from a cup and puts it down on the table",
    "talking on the phone while pacing back and forth",
    "looks around, scratches the head and shrugs",
    "limping as if the right ankle were hurt",
    "staggers like a drunk and nearly falls over",
    "is pushed from behind, stumbles, and recovers balance",
    "walks like a zombie with stiff arms stretched forward",
    "marching like a soldier with high knees, saluting at the end",
    "tiptoeing quietly to avoid being heard",
    "walks along a narrow beam with arms spread for balance, wobbling now and then but never stepping off it",
    "the figure first strolls diagonally across the space, pauses as though listening to somebody, then "
    "spins clockwise on its heels and hurries off in the opposite direction",
)


def sentence_ids(tokenizer_file: str | Path) -> Callable[[str], list[int]]:
    """Sentence -> token ids, without padding or truncation whatever the file says."""
    from tokenizers import Tokenizer

    tokenizer = Tokenizer.from_file(str(tokenizer_file))
    tokenizer.no_padding()
    tokenizer.no_truncation()
    return lambda sentence: list(tokenizer.encode(sentence).ids)


def plain_tokenizer_json(path: str | Path) -> str:
    """The text of a tokenizer file without padding and truncation, compact."""
    content = json.loads(Path(path).read_text(encoding="utf-8"))
    content["padding"] = content["truncation"] = None
    return json.dumps(content, ensure_ascii=False, separators=(",", ":")) + "\n"
