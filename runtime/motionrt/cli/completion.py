"""``motionrt completion``: scripts that let shells complete commands and options."""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial
from typing import Any

from motionrt.cli.options import command

HELP = """print a script that lets a shell complete commands, options and their values
bash:  motionrt completion bash > ~/.local/share/bash-completion/completions/motionrt
zsh:   motionrt completion zsh >> ~/.zshrc
fish:  motionrt completion fish > ~/.config/fish/completions/motionrt.fish"""

_BASH = """\
_motionrt() {
    local cur=${COMP_WORDS[COMP_CWORD]} last=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]} words=
    case " %(groups)s " in *" $command "*) [ "$COMP_CWORD" -gt 2 ] && command="$command ${COMP_WORDS[2]}";; esac
    if [ "$COMP_CWORD" -eq 1 ]; then
        words="%(commands)s"
    else
        case "$command $last" in
%(values)s
        esac
        if [ -z "$words" ]; then case "$command" in
%(options)s
        esac; fi
    fi
    COMPREPLY=($(compgen -W "$words" -- "$cur"))
    case "$cur" in -*) ;; *) [ "$COMP_CWORD" -gt 1 ] && COMPREPLY+=($(compgen -f -- "$cur"));; esac
}
complete -o filenames -F _motionrt motionrt"""
_ZSH = "autoload -U +X compinit && compinit\nautoload -U +X bashcompinit && bashcompinit\n"


def add(commands: Any) -> None:
    """Add the command."""
    parser = command(commands, "completion", partial(run, commands), HELP)
    parser.add_argument("shell", choices=("bash", "zsh", "fish"), help="the shell")


def run(commands: Any, arguments: argparse.Namespace) -> int:
    """Print the script."""
    leaves = dict(_leaves(commands.choices, ""))
    print(_fish(leaves) if arguments.shell == "fish" else _bash(leaves, zsh=arguments.shell == "zsh"))
    return 0


def _leaves(parsers: dict[str, argparse.ArgumentParser], before: str) -> Iterator[tuple[str, list[argparse.Action]]]:
    """Every command by its words, and what it understands."""
    for name, parser in parsers.items():
        actions = parser._actions  # noqa: SLF001 - argparse has no public way to ask
        below = [action.choices for action in actions if isinstance(action.choices, dict)]
        for children in below:
            yield from _leaves(children, f"{before}{name} ")
        if not below:
            yield before + name, [action for action in actions if action.help != argparse.SUPPRESS]


def _bash(leaves: dict[str, list[argparse.Action]], *, zsh: bool) -> str:
    groups = _groups(leaves)
    options, values = [], []
    for group, names in groups.items():
        options.append(f'        "{group}") words="{" ".join(names)}";;')
    for name, actions in leaves.items():
        words = [option for action in actions for option in action.option_strings]
        words += [str(value) for action in actions if not action.option_strings for value in action.choices or ()]
        options.append(f'        "{name}") words="{" ".join(words)}";;')
        values += [
            f'        "{name} {option}") words="{" ".join(map(str, action.choices or ()))}";;'
            for action in actions
            for option in (action.option_strings if action.choices else ())
        ]
    first = dict.fromkeys(name.split()[0] for name in leaves)
    parts = {"commands": " ".join(first), "groups": " ".join(groups)}
    return (_ZSH if zsh else "") + _BASH % {**parts, "options": "\n".join(options), "values": "\n".join(values)}


def _fish(leaves: dict[str, list[argparse.Action]]) -> str:
    groups = _groups(leaves)
    lines = [
        f"complete -c motionrt -f -n __fish_use_subcommand -a {name}"
        for name in dict.fromkeys(name.split()[0] for name in leaves)
    ]
    for group, names in groups.items():
        unseen = f"__fish_seen_subcommand_from {group}; and not __fish_seen_subcommand_from {' '.join(names)}"
        lines.append(f"complete -c motionrt -f -n '{unseen}' -a '{' '.join(names)}'")
    for name, actions in leaves.items():
        seen = "; and ".join(f"__fish_seen_subcommand_from {word}" for word in name.split())
        for action in actions:
            lines += [f"complete -c motionrt -n '{seen}' {part}" for part in _fish_words(action)]
    return "\n".join(lines)


def _fish_words(action: argparse.Action) -> Iterator[str]:
    values = f" -x -a '{' '.join(map(str, action.choices))}'" if action.choices else ""
    if not action.option_strings and values:
        yield values.strip().removeprefix("-x ")
    for option in action.option_strings:
        yield f"-{'l' if option.startswith('--') else 's'} {option.lstrip('-')}{values}"


def _groups(leaves: dict[str, list[argparse.Action]]) -> dict[str, list[str]]:
    """Commands that have commands of their own, and those."""
    found: dict[str, list[str]] = {}
    for first, *rest in (name.split() for name in leaves):
        if rest:
            found.setdefault(first, []).append(rest[0])
    return found
