"""Rules of linting: slips that are planted, where each is found, and what is just no slip."""

from pathlib import Path

import pytest

from foon_asp.linting.linter import lint
from tests.conftest import Cli
from tests.linting.planted import CHOP, findings, unit, written

# --- what is meant is left alone


@pytest.mark.parametrize(
    "text",
    [
        unit("bun;on [tray];covered [foil], tray, foil", "bake", "bun;baked;on [tray], tray"),
        unit("tray;covered {foil};contains {bun}, bun", "bake", "tray;contains {bun}, bun;baked"),
        unit("can;sealed;contains {tuna}", "open", "can;opened;contains {oil,tuna}"),  # shows what is inside
        unit("pot;contains {pasta,water}", "drain", "pot;contains {pasta}"),
        unit("bowl;contains {egg white,egg yolk,salt}", "whisk", "bowl;contains {egg,salt}"),
        unit("tap;on, water;from [tap], leek;dirty", "wash", "leek;clean, tap;on"),
        unit("butter;wrapped", "remove", "butter, wrapping paper"),
        unit("tap;on, cup;empty", "fill", "tap;on, water;from [tap]"),
        unit("bread;on [board];contains {ham}", "cover", "sandwich;on [board];contains {ham}"),  # a product
        unit("cheese;grated;in [bowl]", "add", "tortilla;contains {cheese}, cheese;grated;on [tortilla]")
        + unit("jar;contains {cheese}, cheese;grated;in [jar]", "add", "pan;contains {cheese}, jar"),
        "O\tpan\t0\nM\theat\t0:00:10\t0:01:20\nO\tpan\t0\nS\thot\n//\n",  # h:mm:ss all over
        "O\tкартофель\nM\tchop\nO\tкартофель\nS\tchopped\n//\n",  # one script
        "O\tpurée\nM\theat\nO\tpurée\nS\thot\n//\n",  # one form
    ],
)
def test_what_is_meant_is_left_alone(tmp_path: Path, text: str) -> None:
    assert findings(tmp_path, text) == ""


# --- times


def steps(*times: str) -> str:
    return "".join(
        f"O\tegg {letter}\nM\tboil\t{time}\nO\tegg {letter}\nS\tboiled\n//\n"
        for letter, time in zip("abcdef", times, strict=False)
    )


@pytest.mark.parametrize(
    ("times", "found"),
    [
        (["0:10\t0:60"], "12:13 time-value"),
        (["0:10\t0:59"], ""),
        (["1:60:00\t1:00:00"], "12:8 time-value"),
        # h:mm:ss, beside 0:40 as the latest of m:ss
        (["0:40\t0:40", "0:01:20\t0:01:20"], ""),
        (["0:40\t0:40", "0:01:21\t0:01:30"], "17:8 time-value"),
        (["0:40\t0:40", "0:01:10\t0:01:21"], "17:16 time-value"),
        (["0:01:21\t0:01:30"], ""),  # more than a quarter of all are of that form
        # an hour, and more than four times the usual
        (["59:50\t60:00"], "12:14 time-value"),
        (["59:50\t59:59"], ""),
        (["15:00\t15:00", "15:00\t15:00", "15:00\t15:00", "59:00\t60:00"], ""),
        (["14:59\t14:59", "14:59\t14:59", "14:59\t14:59", "59:00\t60:00"], "27:14 time-value"),
        # the end before the beginning, or long after
        (["0:20\t0:10"], "12:13 time-value"),
        (["0:20\t0:20"], ""),
        (["0:10\t20:10"], "12:13 time-value"),
        (["0:10\t20:09"], ""),
        (["0:00\t1:40", "1:40\t3:20", "3:20\t5:00", "3:20\t36:40"], "27:13 time-value"),
        (["0:00\t1:40", "1:40\t3:20", "3:20\t5:00", "3:20\t36:39"], ""),
        # in one field
        (["<0:30,0:10>"], "12:14 time-value"),
        (["<0:12-0:34,0:40-0:30>"], "12:24 time-value"),
        (["<0:12-0:34,0:40-0:50>"], ""),
        (["<0:12-0:34,0:30>"], ""),
    ],
)
def test_times(tmp_path: Path, times: list[str], found: str) -> None:
    assert findings(tmp_path, steps("0:10\t0:20", "0:30\t0:40", *times)) == found


def chained(*timed: tuple[str, str, str]) -> str:
    return "".join(f"O\tegg {a}\nM\tboil {b}\t{time}\nO\tegg {b}\n//\n" for a, b, time in timed)


@pytest.mark.parametrize(
    ("units", "found"),
    [
        ([("a", "b", "1:00\t1:10"), ("b", "c", "0:30\t0:59")], "6:10 time-order"),
        ([("a", "b", "1:00\t1:10"), ("b", "c", "0:30\t1:00")], ""),
        ([("b", "c", "0:30\t0:59"), ("a", "b", "1:00\t1:10")], ""),  # made behind it: another story
        # made by two: the first counts, wherever it stands
        ([("a", "b", "1:00\t1:10"), ("d", "b", "0:20\t0:25"), ("b", "c", "0:30\t0:40")], ""),
        ([("d", "b", "0:20\t0:25"), ("a", "b", "1:00\t1:10"), ("b", "c", "0:30\t0:40")], ""),
        ([("a", "b", "0:40\t0:45"), ("b", "c", "<0:10-0:20,0:30-0:50>")], ""),  # its end is the last
        # a step of odd times says nothing of others
        ([("a", "b", "1:00\t0:50"), ("b", "c", "0:30\t0:40")], "2:15 time-value"),
    ],
)
def test_the_order_of_times(tmp_path: Path, units: list[tuple[str, str, str]], found: str) -> None:
    assert findings(tmp_path, chained(*units)) == found


# --- letters


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("O\tte\u200ba", "1:5 ambiguous-letter"),
        ("O\ttea\xa0pot", "1:6 ambiguous-letter"),
        ("O\tte\x07a\u200b", "1:5 ambiguous-letter"),  # once for each line
        ("# te\u200ba\nO\ttea", ""),
        ("O\tcake\nS\t\u0430\u0440ple", "2:3 ambiguous-letter"),  # two Cyrillic letters among three Latin
        ("O\tcake\nS\tpie \u0430\u0440p", "2:9 ambiguous-letter"),
        ("O\t\u03b1\u0430x", "1:3 ambiguous-letter"),
        ("O\tna\u00efve", ""),
        ("O\tpi\u00f1a\nS\tpin\u0303a", "2:3 ambiguous-letter"),  # as often: the usual form is right
        ("O\tpi\u00f1a\nS\tpin\u0303a\nS\tpin\u0303a x", "1:3 ambiguous-letter"),
    ],
)
def test_letters(tmp_path: Path, lines: str, found: str) -> None:
    told = findings(tmp_path, lines + "\nM\tgo\nO\tjoy\n//\n").split(", ")
    assert ", ".join(each for each in told if not each.endswith("misspelt")) == found


# --- ids and flags

WITH_ID = "O1\tmilk\nM1\theat\nO1\tmilk\nS1\thot\n//\n"


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (WITH_ID + WITH_ID.replace("milk", "egg"), "6:1 id-of-two-names"),
        (WITH_ID + WITH_ID.replace("O1\tmilk", "O2\tegg").replace("M1", "M2"), "7:1 name-of-two-ids"),
        (
            "O1\tmilk\nO1\tegg\nO1\tsalt\nM1\tmix\nO2\tdough\n//\n",
            "2:1 id-of-two-names, 3:1 id-of-two-names",
        ),
        ("O1\tmilk\nO1\tegg\nO1\tsalt\nO1\toil\nM1\tmix\nO2\tdough\n//\n", "1:1 id-of-two-names"),
        # one line of twenty without an id, and one of nineteen
        (
            WITH_ID
            + "".join(WITH_ID.replace("O1\tmilk", f"O{n}\tegg {n}") for n in range(2, 5))
            + "O\tmilk\nM1\theat\nO1\tmilk\nS1\thot\n//\n",
            "21:1 duplicate-unit, 21:1 missing-field",
        ),
        (
            "".join(WITH_ID.replace("O1\tmilk", f"O{n}\tegg {n}") for n in range(2, 6))
            + "O\tmilk\nM1\theat\nO1\tmilk tea\n//\n",
            "",
        ),
        # flags behind a space, and a few that are missing
        ("O\tegg 1\nO\tmilk\t0\nM\tmix\nO\tmilk\t1\nS\tmixed\n//\n", "1:3 missing-field, 1:3 space-for-tab"),
        ("O\tegg 1\nO\tegg\nM\tmix\nO\tegg\nS\tmixed\n//\n", "1:3 space-for-tab"),
        ("O\tegg 1\nO\tmilk\nM\tmix\nO\tmilk\nS\tmixed\n//\n", ""),
        ("O\tegg\t1\nO\tmilk\nM\tmix\nO\tmilk\t1\nS\tmixed\n//\n", "2:3 missing-field"),
        ("O\tegg\t1\nO\tmilk\nM\tmix\nO\tmilk\t1\nS\tmixed\nO\tegg\n//\n", ""),  # as many with as without
        ("O\tegg\t0\nO\tmilk\t0\nO\tsalt\n", ""),  # a kitchen
    ],
)
def test_ids_and_flags(tmp_path: Path, text: str, found: str) -> None:
    assert findings(tmp_path, text) == found


# --- one object

BESIDE = "O\tegg\n{}\nO\tpan\nO\tbowl\nM\tmix\nO\tegg\nS\tmixed\nO\tpan\nO\tbowl\n//\n"


@pytest.mark.parametrize(
    ("lines", "found"),
    [
        ("S\tin\t[pan]\nS\ton\t[bowl]", "3:1 second-relation"),
        ("S\tin\t[pan]\nS\twet\nS\ton\t[bowl]", "4:1 second-relation"),
        ("S\tin\t[pan]\nS\tin\t[bowl]", "3:1 second-relation"),
        ("S\tin\t[pan]\nS\ton\t[sink]", ""),  # of which one is no object here
        ("S\tattached to\t[pan]\nS\tin\t[bowl]", ""),
        ("S\tattached to\t[pan]\nS\tattached to\t[bowl]", "3:1 second-relation"),
        ("S\tcontains\t{pan}\nS\tcontains\t{bowl}", "3:1 second-relation"),
        ("S\tcontains\t{pan}\nS\tcoated\t{pan}", ""),
        ("S\twet\nS\thot\nS\twet", "4:1 repeated-object"),
        ("S\tin\t[pan]\nS\tin\t[pan]", "3:1 repeated-object"),
        ("O\tsalt\nS\twet\nO\toil\nS\twet", ""),
    ],
)
def test_lines_of_one_object(tmp_path: Path, lines: str, found: str) -> None:
    assert findings(tmp_path, BESIDE.format(lines)) == found


# --- brackets


@pytest.mark.parametrize(
    ("text", "fixed"),
    [
        ("S\tin\t{bowl]", None),  # a place, which the reader takes for a list
        ("S\tin\t{bowl] ", None),  # nor by way of another slip on the line
        ("S\tin\t[bowl}", "S\tin\t[bowl]"),
        ("S\tcontains\t{leek]", "S\tcontains\t{leek}"),
        ("S\tin\t{leek,bowl]", "S\tin\t{leek,bowl}"),
    ],
)
def test_brackets_of_two_kinds_are_mended_where_it_is_sure(
    tmp_path: Path, cli: Cli, text: str, fixed: str | None
) -> None:
    whole = f"O\tleek\n{text}\nO\tbowl\nM\tchop\nO\tleek\nS\tchopped\n//\n"
    file = tmp_path / "a.txt"
    file.write_text(whole)
    assert "[bracket]" in cli("lint", file).out
    cli("lint", file, "--fix")
    assert file.read_text() == (whole if fixed is None else whole.replace(text, fixed))


IN_BRACKETS = "O\tegg\n{}\nO\tpan\nM\tmix\nO\tegg\nS\tmixed\nO\tpan\n//\n"


@pytest.mark.parametrize(
    ("line", "known", "found"),
    [
        # a bracket of the other kind, where ten times as many lines have it
        ("S\tholds\t[pan]", "relation { }\tholds\t10", "2:9 other-bracket"),
        ("S\tholds\t[pan]", "relation { }\tholds\t9", ""),
        ("S\tholds\t{pan,egg}", "relation [ ]\tholds\t10", "2:9 other-bracket"),
        # or where the same stands so more often
        (
            "S\tholds\t[lid]\nO\toil\nS\tholds\t{lid}\nO\tsalt\nS\tholds\t{lid}",
            "object\tlid",
            "2:9 other-bracket",
        ),
        ("S\tholds\t[lid]\nO\toil\nS\tholds\t{lid}", "object\tlid", ""),
        # what others are in is no content
        ("S\tholds\t{pan}", "relation [ ]\tholds\t1\nutensil\tpan", "2:9 other-bracket"),
        ("S\tholds\t{pan}", "relation [ ]\tholds\t1", ""),
        # none at all, behind a word that has them
        ("S\tholds pan", "relation [ ]\tholds\t1", "2:3 misread-line"),
        ("S\theld up by pan", "relation [ ]\theld up by\t1", "2:3 misread-line"),
        ("S\tholds pan, egg", "relation { }\tholds\t1", "2:3 misread-line"),
        ("S\tholds pan, joy", "relation { }\tholds\t1", ""),
        ("S\tholds joy", "relation [ ]\tholds\t1", ""),
        ("S\tcontains joy", "relation { }\tcontains\t1", "2:3 misread-line"),
        ("S\tholds pan", "relation [ ]\tholds\t1\nstate\tpan", ""),  # a state that is known
    ],
)
def test_brackets_are_held_against_those_elsewhere(tmp_path: Path, line: str, known: str, found: str) -> None:
    names = tmp_path / "names.txt"
    names.write_text(f"{known}\nhabit\tmix\t9\t9\t9\t9\t9\t9\n".lstrip("\n"))
    assert findings(tmp_path, IN_BRACKETS.format(line), vocabulary=names) == found


# --- goals, kitchens and tables: what is mostly of another network is told once


@pytest.mark.parametrize(("unknown", "known", "found"), [(10, 0, 10), (11, 0, 1), (11, 10, 1), (11, 11, 11)])
@pytest.mark.parametrize("name", ["kitchen.txt", "goals.txt", "motion.txt"])
def test_lists_of_another_network_are_told_once(
    tmp_path: Path, cli: Cli, name: str, unknown: int, known: int, found: int
) -> None:
    letters = "abcdefghijklmnopqrstuvwxyz"
    made = "".join(f"O\tegg\nM\tboil {x}\nO\tegg\nS\tboiled {x}\n//\n" for x in letters[:known] or "a")
    (tmp_path / "FOON.txt").write_text(made)
    if name == "motion.txt":
        rows = [f"boil {x}\t0.5" for x in letters[:known]] + [f"fry {x}\t0.5" for x in letters[:unknown]]
    else:
        rows = [f"O\tegg\nS\tboiled {x}" for x in letters[:known]] + [
            f"O\tpan {x}" for x in letters[:unknown]
        ]
    (tmp_path / name).write_text("\n".join(rows) + "\n")
    code = {"kitchen.txt": "unknown-item", "goals.txt": "unmade-goal", "motion.txt": "unknown-row"}[name]
    told = cli("lint", tmp_path, "--select", code, "--format", "json").json["findings"]
    assert len(told) == found
    assert told[0]["line"] == (known if name == "motion.txt" else 2 * known) + 1
    assert (f"{unknown} of the {unknown + known} " in told[0]["message"]) == (found == 1)


# --- units and what they change


@pytest.mark.parametrize(
    ("text", "found"),
    [
        # the order of lines, ids and times do not make another unit
        (
            "O1\ta\t1\nS\tx\nS\ty\nO\tb\t1\nM\tmix\t0:01\t0:02\nO\tc\t1\n//\n"
            "O\tb\t0\nO1\ta\t0\nS\ty\nS\tx\nM\tmix\nO\tc\t0\n//\n",
            "8:1 duplicate-unit",
        ),
        (f"# From:\tsoup.txt:40\n{CHOP}# From:\tsoup.txt:90\n{CHOP}", "9:1 duplicate-unit"),
        (unit("egg, egg, milk", "mix", "egg;mixed, egg;mixed"), "2:3 repeated-object, 7:3 repeated-object"),
        (unit("egg, egg", "mix", "egg;mixed") + unit("egg;mixed", "fry", "egg;fried"), "2:3 repeated-object"),
        (unit("egg, milk", "mix", "milk, egg"), "1:1 no-effect"),
        (unit("egg, milk", "mix", "milk, egg, egg"), "1:1 no-effect, 6:3 repeated-object"),
    ],
)
def test_units(tmp_path: Path, text: str, found: str) -> None:
    assert findings(tmp_path, text) == found


MIXED = "bowl;contains {flour}"
SHOWN = "bowl;contains {flour,salt}"
EGG = unit("egg, pan", "fry", "pan;contains {egg}")


@pytest.mark.parametrize(
    ("text", "habit", "found"),
    [
        # units with the motion, of these keep, lose, gain, make, end: what one of eight does is no habit
        (unit(SHOWN, "zap", MIXED), "7 7 0 0 0 0", "4:3 lost-contents"),
        (unit(SHOWN, "zap", MIXED), "6 6 0 0 0 0", ""),
        (unit(SHOWN, "zap", MIXED), "7 1 0 0 0 0", ""),  # too few keep anything
        (unit(SHOWN, "zap", MIXED), "15 15 2 0 0 0", ""),
        (unit(MIXED, "zap", SHOWN), "7 7 0 0 0 0", "4:3 gained-contents"),
        (unit(MIXED, "zap", SHOWN), "6 6 0 0 0 0", ""),
        (unit(MIXED, "zap", f"{MIXED}, leek"), "7 7 0 0 0 0", "6:3 from-nothing"),
        (unit(MIXED, "zap", f"{MIXED}, leek"), "6 6 0 0 0 0", ""),
        (
            unit("leek;whole", "chop", "leek;chopped") + unit(MIXED, "zap", f"{MIXED}, leek;chopped"),
            "0 0 0 0 9 0",  # another unit makes it
            "12:3 from-nothing",
        ),
        (unit(f"{MIXED}, egg", "zap", f"{MIXED};hot") + EGG, "7 7 0 0 0 0", "3:3 vanished"),
        (unit(f"{MIXED}, egg", "zap", f"{MIXED};hot") + EGG, "6 6 0 0 0 0", ""),
        (unit(SHOWN, "zap", f"{MIXED}, salt"), "7 7 0 0 0 0", ""),  # it is taken out
        # where something loses and gains, or comes and goes, it is called otherwise
        (unit(SHOWN, "zap", "bowl;contains {flour,oil}"), "9 9 0 0 0 0", ""),
        (unit(f"{MIXED}, egg", "zap", f"{MIXED}, omelette") + EGG, "9 9 0 0 0 0", ""),
        # a name is one with another in the plural, or with what begins alike
        (unit("bowl;contains {egg,flour}", "zap", "bowl;contains {eggs,flour}"), "9 9 0 0 0 0", ""),
        (unit(f"{MIXED}, oil;wrapped", "zap", f"{MIXED}, oil, wrapper"), "9 9 0 0 0 0", ""),
        (
            unit(f"{MIXED}, salt", "zap", "bowl;contains {flour};salted") + EGG.replace("egg", "salt"),
            "9 9 0 0 0 0",
            "",
        ),
    ],
)
def test_what_units_change_is_held_against_habits(tmp_path: Path, text: str, habit: str, found: str) -> None:
    names = tmp_path / "names.txt"
    names.write_text(
        "object\tflour salt oil egg eggs leek bowl\nhabit\tzap\t"
        + habit.replace(" ", "\t")
        + "\nhabit\tfry\t9\t9\t9\t9\t9\t9\n"
    )
    assert findings(tmp_path, text, vocabulary=names) == found


# --- places

ANOTHER = unit(
    "plate;contains {bread}, bread;sliced", "add", "plate;contains {bread}, bread;sliced;on [plate]"
) + unit("plate;contains {bread}, bread;sliced;on [plate]", "eat", "plate;dirty")
IN_BOWL = "bowl;contains {leek,salt}, leek;chopped;in [bowl], salt;in [bowl]"
STIRRED = IN_BOWL.replace("chopped", "chopped;mixed")


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (unit("leek;chopped;on [board], pan;empty", "scrape", "pan;contains {leek}, board"), "1:3 left-out"),
        (unit(f"{IN_BOWL}, spoon", "mix", f"{STIRRED}, spoon"), ""),
        (unit(f"{IN_BOWL}, spoon", "mix", IN_BOWL).replace("S\tin\t[bowl]\n", "", 1), "3:3 other-place"),
        (unit(f"{IN_BOWL}, spoon", "mix", STIRRED).replace("S\tin\t[bowl]\n", ""), ""),  # never said
        (unit(IN_BOWL, "mix", STIRRED) + ANOTHER, ""),
        (
            unit(IN_BOWL, "mix", STIRRED) + ANOTHER.replace("S\ton\t[plate]\n", "", 1),
            "20:3 other-place, 25:3 other-place",
        ),
        (
            unit(f"{IN_BOWL}, egg;in [bowl]", "mix", f"{STIRRED}, egg;in [bowl];mixed") + EGG,
            "8:3 unheld, 19:3 unheld",
        ),
        (
            unit(
                f"{IN_BOWL}, egg;in [bowl], oil;in [bowl]", "mix", f"{STIRRED}, egg;in [bowl], oil;in [bowl]"
            )
            + EGG
            + EGG.replace("egg", "oil"),
            "",
        ),  # two of them: they are being put there
        (  # which bowl?
            unit(f"{IN_BOWL}, egg;in [bowl], bowl;empty, pot;contains {{oil}}, milk;in [pot]", "mix", STIRRED)
            + EGG
            + EGG.replace("egg", "milk"),
            "14:3 unheld",
        ),
        (
            unit(f"{IN_BOWL.replace('chopped;in [bowl]', 'in [pan]')}, spoon", "mix", STIRRED) + EGG,
            "3:3 other-place",
        ),
        (
            unit(f"{IN_BOWL.replace('chopped;in [bowl]', 'in [sky]')}, spoon", "mix", STIRRED),
            "4:7 unknown-container",
        ),
    ],
)
def test_what_is_in_something_that_is_not_there(tmp_path: Path, text: str, found: str) -> None:
    told = findings(tmp_path, text).split(", ")
    kinds = {"left-out", "other-place", "unheld", "unknown-container"}
    assert ", ".join(each for each in told if each.split(" ")[-1] in kinds) == found


# --- from unit to unit


def between(count: int) -> str:
    return "".join(unit(f"egg {n}", "crack", f"egg {n};cracked") for n in range(count))


IN = "in [bowl], bowl"
TAKE_WASHED = unit(f"leek;chopped;washed;{IN}", "eat", "bowl;dirty")


@pytest.mark.parametrize(
    ("made", "taken", "far", "found"),
    [
        # one state more, at most 25 units later
        (f"leek;chopped;{IN}", f"leek;chopped;washed;{IN}", 25, "both"),
        # a state or a relation in place of another
        (f"leek;chopped;{IN}", f"leek;diced;{IN}", 8, "both"),
        ("leek;chopped, bowl", "leek;diced, bowl", 0, ""),  # of which there are many
        (f"leek;chopped;{IN}", "leek;chopped;in [pan], pan", 0, ""),  # each with its place
        ("leek;chopped;in [bowl]", "leek;chopped;in [pan], pan", 8, "both"),
        (f"leek;chopped;{IN}", "leek;chopped;on [bowl], bowl", 25, "both"),  # a slip of the pen
        (f"leek;cold;{IN}", "leek;cold", 2, "both"),
        ("leek;chopped, bowl", "leek;chopped;in [bowl], bowl", 25, "both"),
        # another label, with parts that are the same
        (f"leek;chopped;{IN}", f"onion;chopped;{IN}", 2, "both"),
        ("leek;chopped, bowl", "onion;chopped, bowl", 0, ""),
        # contents with one more, not with two
        ("bowl;contains {leek,oil,salt}", "bowl;contains {leek,salt}", 25, "both"),
        ("bowl;contains {leek,oil,salt}", "bowl;contains {leek}", 0, ""),
        ("bowl;contains {leek,salt}", "bowl;contains {leek}", 0, ""),
        ("bowl;contains {leek,salt}", "bowl;contains {leak,salt}", 25, "both"),
        # two differences
        (f"leek;chopped;hot;{IN}", f"leek;diced;cold;{IN}", 0, ""),
        ("bowl;hot;contains {leek,oil,salt}", "bowl;contains {leek,salt}", 0, ""),
    ],
)
def test_chains_that_break(tmp_path: Path, made: str, taken: str, far: int, found: str) -> None:
    start, end = unit("leek, oil, salt, onion, bowl", "add", made), unit(taken, "eat", "bowl;dirty")
    for apart, expected in ((far, found), (far + 1, "")):
        if apart:
            told = findings(tmp_path, start + between(apart - 1) + end)
            assert told.count("broken-chain") == (2 if expected else 0), told


def test_a_state_that_is_missed_where_the_other_node_is_taken_too(tmp_path: Path) -> None:
    start = unit("leek, bowl", "chop", f"leek;chopped;washed;{IN}")
    for apart, count in ((8, 1), (9, 0)):
        text = (
            start + between(apart - 1) + unit(f"leek;chopped;{IN}", "fry", "leek;fried, bowl") + TAKE_WASHED
        )
        assert findings(tmp_path, text).count("broken-chain") == count


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (
            unit("leek, pan", "cut", "pan;contains {leek}")
            + unit("pan;contains {leek}, leek;in [pan]", "fry", "pan;contains {leek}, leek;fried;in [pan]"),
            "4:3 left-out",
        ),
        (
            unit("leek, salt, pan", "cut", "leek;in [pan], salt;in [pan]")
            + unit(
                "pan;contains {leek,salt}, leek;in [pan], salt;in [pan]", "fry", "pan;contains {leek,salt}"
            ),
            "5:3 left-out",
        ),
        (
            unit("leek, pan", "cut", "pan;contains {leek}")
            + between(24)
            + unit("pan;contains {leek}, leek;in [pan]", "fry", "pan;contains {leek}, leek;fried;in [pan]"),
            "4:3 left-out",
        ),
        (
            unit("leek, pan", "cut", "pan;contains {leek}")
            + between(25)
            + unit("pan;contains {leek}, leek;in [pan]", "fry", "pan;contains {leek}, leek;fried;in [pan]"),
            "",
        ),
    ],
)
def test_what_is_left_out(tmp_path: Path, text: str, found: str) -> None:
    told = findings(tmp_path, text).split(", ")
    assert ", ".join(each for each in told if each.endswith("left-out")) == found


# --- messages

PUT = unit("white rice, brown rice", "mix", "brown rice;in [xyrq]") + unit(
    "egg", "put", "cup;contains {rice}"
)
IN_TWO = BESIDE.format("S\tin\t[pan]\nS\tin\t[bowl]")
RING = "".join(unit(f"gate {n}", f"turn {n}", f"gate {(n + 1) % 6}") for n in range(6))


@pytest.mark.parametrize(
    ("files", "code", "message"),
    [
        (
            {"a.txt": WITH_ID * 2 + WITH_ID.replace("milk", "egg")},
            "id-of-two-names",
            "the object id O1 is that of 'egg' (twice) and of 'milk' (4 times, first on line 1); one needs "
            "another id",
        ),
        (
            {"a.txt": "O1\tsalt\nO1\tflour\nO1\tmilk\nO1\teggs\nM\tmix\nO\tdough\n//\n"},
            "id-of-two-names",
            "the object id O1 is that of 4 names: 'salt' (1), 'flour' (1), 'milk' (1), ...; ids should tell "
            "names apart, or be left out",
        ),
        (
            {"a.txt": IN_TWO + IN_TWO.replace("mix", "stir")},
            "second-relation",
            "'egg' is 'in [bowl]' besides 'in [pan]'; both count: if one is outdated, take it out (twice in "
            "this file)",
        ),
        (
            {"a.txt": PUT, "b.txt": PUT},
            "unknown-container",
            "'xyrq' stands in [ ] twice in 2 files, and is never an object; no unit takes or makes it",
        ),
        (
            {"a.txt": PUT + unit("brown rice", "wash", "brown rice;clean")},
            "unknown-ingredient",
            "'rice' is an ingredient once, and is never an object; is it 'brown rice' or 'white rice'?",
        ),
        (
            {"a.txt": CHOP, "kitchen.txt": "O\tonion\nS\tred\n"},
            "unknown-item",
            "'onion; red' is no object node of the network; there is 'onion; whole' and 1 more called "
            "'onion'",
        ),
        (
            {"a.txt": unit("egg", "boil", "soup"), "kitchen.txt": "O\tegg\nS\tred\nO\tham\n"},
            "unknown-item",
            "'egg; red' is no object node of the network; there is 'egg'\n"
            "'ham' is no object node of the network; none there is called 'ham'",
        ),
        (
            {"a.txt": RING, "motion.txt": "turn 0\t0.5\nturn 1\t0.5\n"},
            "missing-rate",
            "4 motions of the network without a rate: 'turn 2', 'turn 3', 'turn 4', ...",
        ),
        (
            {"a.txt": RING, "motion.txt": "turn 0\t0.5\nturn 1\t0.5\nturn 2\t0.5\n"},
            "missing-rate",
            "3 motions of the network without a rate: 'turn 3', 'turn 4', 'turn 5'",
        ),
        (
            {"a.txt": RING},
            "dead-cycle",
            "only units that need 'gate 0' make it: from it 'turn 0' (line 1) makes 'gate 1', from that "
            "'turn 1' (line 5) makes 'gate 2', from that 'turn 2' (line 9) makes 'gate 3', from that 2 more "
            "steps, from that 'turn 5' (line 21) makes 'gate 0'; it has to be in the kitchen, or made in "
            "another way",
        ),
    ],
)
def test_messages(tmp_path: Path, files: dict[str, str], code: str, message: str) -> None:
    paths = written(tmp_path, *files.values(), names=tuple(files))
    assert "\n".join(each.message for each in lint(paths) if each.code == code) == message
