"""Words of an action text: tokens and their base forms."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import dataclass

_TOKEN = re.compile(r"[a-z]+(?:'[a-z]+)?|\d+|[,;.:!?&/]")
_LONGEST = 2000  # words that are read of one text
_FORMS = (
    "run:ran sit:sat stand:stood lie:lay,lain,lying get:got,gotten go:went,gone,goes throw:threw,thrown "
    "catch:caught fall:fell,fallen rise:rose,risen swing:swung bend:bent spin:spun swim:swam,swum kneel:knelt "
    "leap:leapt creep:crept drink:drank eat:ate,eaten take:took,taken give:gave,given hold:held "
    "keep:kept put:put,putting shake:shook,shaken strike:struck,stricken fight:fought ride:rode,ridden "
    "drive:drove,driven write:wrote,written draw:drew,drawn bring:brought stick:stuck dig:dug hang:hung "
    "fling:flung sling:slung wring:wrung cling:clung dive:dove sweep:swept sleep:slept weep:wept lean:leant "
    "come:came begin:began,begun make:made do:did,done,does have:had,has be:is,are,was,were,been,"
    "being,am,'s bow:bowed fly:flew,flown blow:blew,blown tear:tore,torn wear:wore,worn bite:bit,bitten "
    "hide:hid,hidden slide:slid speak:spoke,spoken sing:sang,sung ring:rang,rung shoot:shot stride:strode "
    "tread:trod,trodden wind:wound feed:fed lead:led feel:felt tie:tying die:dying tell:told "
    "say:said foot:feet tooth:teeth knife:knives calf:calves leaf:leaves shelf:shelves spring:sprang,sprung "
    "sink:sank,sunk shrink:shrank wake:woke,woken freeze:froze,frozen choose:chose break:broke,broken "
    "steal:stole,stolen weave:wove,woven forget:forgot buy:bought teach:taught seek:sought build:built "
    "lay:laid pay:paid let:letting hit:hitting cut:cutting show:shown sew:sewn saw:sawn mow:mown sow:sown "
    "meet:met bear:bore,borne"
)
_IRREGULAR = {form: base for base, forms in (entry.split(":") for entry in _FORMS.split()) for form in forms.split(",")}


@dataclass(frozen=True)
class Word:
    """A word as it stands in the text, and the base forms that it may be a form of (itself among them)."""

    text: str
    bases: tuple[str, ...]

    @property
    def inflected(self) -> bool:
        """Whether it has a form that only verbs have: -ing, -ed or an irregular one."""
        return self.text in _IRREGULAR or (self.text.endswith(("ing", "ed")) and len(self.bases) > 1)


def words_of(text: str) -> list[Word]:
    """The words and marks of ``text``: lower case, without accents, hyphenated words apart."""
    plain = unicodedata.normalize("NFKD", text).lower().replace("\u2019", "'")
    plain = "".join(letter for letter in plain if not unicodedata.combining(letter))
    tokens = [match.group() for _, match in zip(range(_LONGEST), _TOKEN.finditer(plain), strict=False)]
    return [Word(token, base_forms(token)) for token in tokens]


def base_forms(word: str) -> tuple[str, ...]:
    """Base forms that ``word`` may come from, itself first: "waving" -> waving, wav, wave."""
    found = [word]
    if word in _IRREGULAR:
        found.append(_IRREGULAR[word])
    if word.endswith("'s"):
        found.append(word[:-2])
    for ending, replacements in _ENDINGS:
        if word.endswith(ending) and len(word) - len(ending) >= 2:
            stem = word[: -len(ending)]
            found += [stem + replacement for replacement in replacements]
            if ending in ("ing", "ed") and len(stem) > 2 and stem[-1] == stem[-2]:
                found.append(stem[:-1])
            break
    return tuple(dict.fromkeys(found))


_ENDINGS = (
    ("ying", ("ie", "y")),
    ("ing", ("", "e")),
    ("ied", ("y", "ie")),
    ("ed", ("", "e")),
    ("ies", ("y", "ie")),
    ("es", ("", "e")),
    ("s", ("",)),
)
