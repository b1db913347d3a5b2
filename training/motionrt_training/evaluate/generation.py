r"""Measure text to motion: two actions at once, prompts judged by the retrieval model, and body-part labels.

    python -m motionrt_training.evaluate.generation pairs --recordings runs/recordings.npz \
        --captions ../shared/data/mocap/cmu/captions.jsonl --encoder runs/temos/best.pt --samples 10 \
        --row "single-action=runs/single/best.pt" --row "single-action, composed=compose:runs/single/best.pt" \
        --row "SINC without synthetic pairs=runs/real/best.pt" --row "SINC=runs/temos/best.pt"
    python -m motionrt_training.evaluate.generation prompts --recordings ... --captions ... --samples 5
    python -m motionrt_training.evaluate.generation parts --recordings ... --captions ... --phrases part_labels.tsv

A row is NAME=[KIND:]PATH of a checkpoint or of a manifest of exported models. Kinds: text (both actions in one
sentence; the default), compose (each alone, then composed by the labels' body parts), compose-rules (by the parts that
the labeller reads out of the texts), separate (two texts encoded separately), diffusion (a manifest's denoiser).
Markdown goes to the screen or to -o, all figures to --json.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import numpy as np

from motionrt import Runtime
from motionrt.models import Sessions, TextMotionModel
from motionrt.motion import Motion
from motionrt.motion.skeleton import FloatArray
from motionrt.retrieval import motion_features
from motionrt.retrieval.windows import WINDOW_FRAMES
from motionrt.synthesis.generating import Generator
from motionrt.synthesis.parts import Endpoint, PromptLabeller, RulesLabeller, relative_velocity_parts, velocity_parts
from motionrt.synthesis.parts.prompting import STYLES
from motionrt_training.backbones import Backbone, open_backbone
from motionrt_training.corpora.actions import ActionClip, read_actions
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.evaluate import pair_tables, part_labels, prompts
from motionrt_training.evaluate.latents import load_latents
from motionrt_training.evaluate.simultaneous import LONGEST, WHILE, clip_motion, read_action_pairs
from motionrt_training.evaluate.ways import WAYS, Way, composed, diffused, first_pose

Result = tuple[str, Mapping[str, object]]  # Markdown, and everything for JSON


def pairs(args: argparse.Namespace) -> Result:
    """Table 2 and 3 of SINC on the test split."""
    backbone = open_backbone("onnx", args.sentences)
    found = read_action_pairs(args.recordings, args.captions, args.split, args.longest, args.form)
    encoders: dict[str, pair_tables.MotionEncoder] = {}
    if args.encoder:
        encoders["TEMOS"] = load_latents(args.encoder, backbone).motion
    encoders["retrieval"] = _retrieval(args.models)
    ruler = pair_tables.Ruler(found, encoders, args.samples)
    rows = {name: ruler.row(_way(spec, backbone)) for name, spec in args.row}
    rows["first pose of the recording, held"] = ruler.row(first_pose)
    return pair_tables.pair_page(rows, found, args.samples), pair_tables.as_json(rows, found)


def prompted(args: argparse.Namespace) -> Result:
    """The retrieval test of generated motion, through the public API."""
    runtime, asked = Runtime(args.models), prompts.read_prompts(args.prompts)
    texts = [prompt.text for prompt in asked]
    train, test = _clips(args, "train"), _clips(args, "test")
    known = runtime.embed_motion([clip_motion(clip) for clip in train])
    rows = {}
    for sampler in args.sampler:
        for lock in (True, False):
            motions = prompts.generated(runtime, asked, args.samples, sampler, foot_lock=lock)
            row = prompts.judged(runtime, texts, motions, recordings=known)
            rows[f"{sampler}, feet {'locked' if lock else 'free'}"] = row
    rows["chance"] = prompts.by_chance()
    for name, clips in (("training", train), ("test", test)):
        found = prompts.looked_up(asked, clips, runtime.model.sentences.embed)
        rows[f"{name} clip of the nearest caption"] = prompts.judged(runtime, texts, found, recordings=known)
    rows["its first pose, held"] = prompts.judged(runtime, texts, prompts.frozen(found), recordings=known)
    rows["recorded test clips, own captions"] = prompts.recorded(runtime, test, recordings=known)
    rows["recorded test clips, feet locked"] = prompts.recorded(runtime, test, locked=True, recordings=known)
    return prompts.prompt_page(rows, asked, args.samples), prompts.as_json(rows, asked)


def parts(args: argparse.Namespace) -> Result:
    """Accuracy of the labellers."""
    rules: dict[str, part_labels.Labeller] = {"rules": RulesLabeller()}
    if args.endpoint:
        endpoint = Endpoint(args.endpoint, args.llm)
        rules |= {f"prompt: {style}": PromptLabeller(endpoint=endpoint, style=style) for style in STYLES}
    tables = {}
    if args.phrases:
        tables["phrases answered by hand"] = part_labels.on_phrases(rules, part_labels.read_phrases(args.phrases))
    if args.recordings and args.captions:
        clips = _clips(args, "test")
        tables["labels of the test clips"] = part_labels.on_labels(rules, clips)
        tables["test clips, all labels together"] = part_labels.on_clips(
            rules, {"velocity": velocity_parts, "velocity, as published": relative_velocity_parts}, clips
        )
    figures = {title: {name: row.as_dict() for name, row in rows.items()} for title, rows in tables.items()}
    return part_labels.part_page(tables), figures


def _way(spec: str, backbone: Backbone) -> Way:
    kind, separator, path = spec.partition(":")
    if separator and kind == "diffusion":
        return diffused(Generator(Sessions(path)))
    if separator and kind == "compose-rules":
        return composed(load_latents(path, backbone), RulesLabeller())
    if separator and kind in WAYS:
        return WAYS[kind](load_latents(path, backbone))
    return WAYS["text"](load_latents(spec, backbone))


def _retrieval(models: Path | None) -> pair_tables.MotionEncoder:
    model = TextMotionModel(models)

    def encode(motion: Motion) -> FloatArray:
        return np.asarray(model.embed_motion([motion_features(motion)[:WINDOW_FRAMES]])[0])

    return encode


def _clips(args: argparse.Namespace, split: str) -> list[ActionClip]:
    clips = read_actions(load_recordings(args.recordings), args.captions)
    return [clip for clip in clips if clip.split == split]


def parser() -> argparse.ArgumentParser:
    """Every option with its default."""
    result = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = result.add_subparsers(required=True)
    table = _command(commands, "pairs", pairs, corpus=True)
    table.add_argument("--row", action="append", default=[], type=_named, metavar="NAME=[KIND:]PATH", help="a line")
    table.add_argument("--encoder", type=Path, help="checkpoint whose motion encoder gives the TEMOS score")
    table.add_argument("--sentences", type=Path, default=Path("models/tmr_text.int8.onnx"), help="text encoder")
    table.add_argument("--samples", type=int, default=0, help="samples of every pair, beside the mean latent's motion")
    table.add_argument("--split", default="test", help="train, val or test")
    forms = "how two labels are said: {0}, {1}, {0g}, {1g} (gerunds); the paper's test and its Table A.3 try several"
    table.add_argument("--form", default=WHILE, help=f"{forms} (default: %(default)s)")
    table.add_argument("--longest", type=int, default=LONGEST, help="frames of a pair at most (default: %(default)s)")
    judge = _command(commands, "prompts", prompted, corpus=True)
    judge.add_argument("--prompts", type=Path, default=prompts.PROMPTS, help="lines of 'seconds | prompt'")
    judge.add_argument("--samples", type=int, default=5, help="motions of every prompt (default: %(default)s)")
    judge.add_argument("--sampler", nargs="+", default=["diffusion", "vae"], help="samplers of generate")
    label = _command(commands, "parts", parts, corpus=False)
    label.add_argument("--phrases", type=Path, help="phrases with answers by hand (.tsv)")
    label.add_argument("--endpoint", help="OpenAI-compatible server whose model answers the prompts of SINC's Table 1")
    label.add_argument("--llm", default="default", help="its model (default: %(default)s)")
    return result


def _command(
    commands: argparse._SubParsersAction[argparse.ArgumentParser],
    name: str,
    run: Callable[[argparse.Namespace], Result],
    *,
    corpus: bool,
) -> argparse.ArgumentParser:
    added: argparse.ArgumentParser = commands.add_parser(name, help=run.__doc__)
    added.set_defaults(run=run)
    added.add_argument("--recordings", type=Path, required=corpus, help="packed recordings (.npz)")
    added.add_argument("--captions", type=Path, required=corpus, help="captions.jsonl of the corpus")
    added.add_argument("--models", type=Path, help="models manifest or folder (default: the shipped ones)")
    added.add_argument("-o", "--out", type=Path, help="write the Markdown there instead of printing it")
    added.add_argument("--json", type=Path, help="write all figures there")
    return added


def _named(text: str) -> tuple[str, str]:
    name, separator, path = text.partition("=")
    if not separator or not path:
        raise argparse.ArgumentTypeError(f"expected NAME=[KIND:]PATH, not '{text}'")
    return name, path


def main(arguments: Sequence[str] | None = None) -> None:
    """The command line."""
    args = parser().parse_args(arguments)
    page, figures = args.run(args)
    if args.out:
        args.out.write_text(page, encoding="utf-8", newline="\n")
    else:
        print(page)
    if args.json:
        args.json.write_text(json.dumps(figures, indent=1), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
