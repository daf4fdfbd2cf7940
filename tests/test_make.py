"""The pattern rules of samples/penink.mk, driven by make itself, and what the Makefile would remove."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

from tests.conftest import ROOT, environment

STAGES = [f"disc.{stage}" for stage in ("edges.json", "samples.pgm", "reduced.pgm", "grey.pgm", "strokes.jsonl", "ps")]


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "Makefile").write_text(f"include {ROOT}/samples/penink.mk\n")
    y, x = np.mgrid[:64, :64] + 0.5
    disc = np.where(np.hypot(x - 32, y - 32) < 20, 60, 220).astype(np.uint8)
    (tmp_path / "disc.pgm").write_bytes(b"P5 64 64 255\n" + disc.tobytes())
    return tmp_path


def make(folder, *arguments):
    program = f"PENINK={sys.executable} -m penink_cli"
    command = ["make", "--no-print-directory", program, "BLAST=--texture crosshatch --width 1in", *arguments]
    env = environment(MAKEFLAGS="")
    return subprocess.run(command, cwd=folder, env=env, capture_output=True, text=True, check=False)


def remade(done) -> list[str]:
    ran = [line for line in done.stdout.splitlines() if "penink_cli" in line and "-o " in line]
    return [line.split("-o ")[1].split()[0] for line in ran]


def test_one_file_a_stage_and_nothing_twice(folder):
    first = make(folder, "-j2", "disc.ps")
    assert first.returncode == 0, first.stderr
    assert remade(first) == STAGES
    assert all((folder / stage).stat().st_size for stage in STAGES)
    assert remade(make(folder, "disc.ps")) == []


@pytest.mark.parametrize(
    ("option", "first_remade"),
    [("REDUCE=--factor 2", 2), ("BLAST.disc=--texture crosshatch --width 2in", 4), ("DETECT=--sigma 2", 0)],
)
def test_a_changed_option_remakes_what_follows_from_it(folder, option, first_remade):
    assert make(folder, "disc.ps").returncode == 0
    again = make(folder, "disc.ps", option)
    assert again.returncode == 0, again.stderr
    assert remade(again) == STAGES[first_remade:]


def test_a_failed_stage_leaves_no_target_and_names_the_file(folder):
    (folder / "disc.pgm").write_bytes((folder / "disc.pgm").read_bytes()[:1000])
    done = make(folder, "disc.ps")
    assert done.returncode != 0
    assert "disc.pgm: truncated" in done.stderr
    assert not list(folder.glob("*.json")) and not list(folder.glob("*.ps"))


def test_the_default_goal_stays_the_includer_s(folder):
    with open(folder / "Makefile", "a") as makefile:
        makefile.write("ours:\n\t@echo ours was made\n")
    assert make(folder).stdout == "ours was made\n"


def test_every_photograph_of_a_folder_has_a_rule_and_no_stage_file_is_one(folder):
    with open(folder / "Makefile", "a") as makefile:
        makefile.write("all: $(addsuffix .ps,$(basename $(call penink-photos,shots)))\n")
    (folder / "shots").mkdir()
    photos = ["a.JPG", "b.tif", "c.jpeg", "d.webp", "e.png", "f.pgm", "g.ppm", "h.TIFF"]
    for name in (*photos, "e.preview.png", "e.samples.pgm", "e.reduced.pgm", "e.grey.pgm", "notes.txt"):
        (folder / "shots" / name).touch()
    plan = make(folder, "--dry-run", "all")
    assert plan.returncode == 0, plan.stderr
    assert {f"shots/{name[0]}.ps" for name in photos} == {t for t in remade(plan) if t.endswith(".ps")}


# What a shell or make could take for more than a name.
STRANGE = [
    "x&touch pwned&y", "$(touch pwned)", "$(shell touch pwned)", "`touch pwned`", "|touch pwned", ";touch pwned",
    "it's", 'say "so"', "(1)", "d$HOME", "$$", "-o", "--help", "{b}", "a!b", "<x>y", "a^b", "a@b,c+d", "ü",
]  # fmt: skip


def gallery(folder, *names):
    """A folder of photographs, and a rule for all that penink-photos finds there."""
    (folder / "shots").mkdir()
    for name in names:
        (folder / "shots" / name).write_bytes((folder / "disc.pgm").read_bytes())
    with open(folder / "Makefile", "a") as makefile:
        makefile.write("all: $(addsuffix .ps,$(basename $(call penink-photos,shots)))\n")


def test_nothing_in_a_name_is_run(folder):
    names = [name for name in STRANGE if not set(name) & set(" ;|")]
    names += [name.replace(" ", "${IFS}") for name in STRANGE if " " in name and not set(name) & set(";|")]
    gallery(folder, *(f"{name}.pgm" for name in names))
    done = make(folder, "-j2", "all")
    assert done.returncode == 0, done.stderr
    assert {path.stem for path in (folder / "shots").glob("*.ps")} == set(names)
    assert sorted(path.name for path in folder.iterdir()) == ["Makefile", "disc.pgm", "shots"]
    (folder / "$(touch${IFS}pwned)&.pgm").write_bytes((folder / "disc.pgm").read_bytes())
    done = make(folder, "$(touch${IFS}pwned)&.preview.png")
    assert done.returncode == 0, done.stderr
    assert (folder / "$(touch${IFS}pwned)&.preview.png").read_bytes().startswith(b"\x89PNG")
    assert not (folder / "pwned").exists()


UNTAKEN = ["a b", " a", "a\tb", "a b.pgm c", "a:b", ";id", "a;id", "a=b", "a|b", "a%b", "a*", "a?"]
UNTAKEN += ["[1]", "a\\b", "~a", "#a"]


@pytest.mark.parametrize("name", UNTAKEN)
def test_what_make_cannot_take_is_refused_by_name_before_anything_runs(folder, name):
    gallery(folder, "fine.pgm", f"{name}.pgm")
    done = make(folder, "all")
    assert done.returncode == 2 and not done.stdout
    assert "penink.mk: " in done.stderr and "rename it" in done.stderr and done.stderr.count("\n") == 1
    assert name.split()[0].split(".")[0] in done.stderr
    assert len(list((folder / "shots").iterdir())) == 2


def test_two_photographs_of_one_name_are_an_error_that_names_both(folder):
    (folder / "disc.JPG").touch()
    done = make(folder, "disc.ps")
    assert done.returncode == 2 and "disc.pgm disc.JPG would all become one drawing" in done.stderr
    assert not (folder / "disc.edges.json").exists()
    gallery(folder, "a.pgm", "a.png", "a.b.png", "b.png")
    done = make(folder, "all")
    assert done.returncode == 2 and not done.stdout
    assert "shots/a.png shots/a.pgm would all become one drawing" in done.stderr
    assert "b.png" not in done.stderr


def test_a_dry_run_and_a_question_tell_the_truth(folder):
    assert make(folder, "--question", "disc.ps").returncode == 1
    assert remade(make(folder, "--dry-run", "disc.ps")) == STAGES
    assert not list(folder.glob("disc.*.*"))  # and do nothing
    assert make(folder, "disc.ps").returncode == 0
    assert make(folder, "--question", "disc.ps").returncode == 0
    idle = make(folder, "--dry-run", "disc.ps")
    assert idle.stdout == "make: 'disc.ps' is up to date.\n" or "Nothing to be done" in idle.stdout
    changed = "BLAST=--texture crosshatch --width 2in"
    assert remade(make(folder, "--dry-run", "disc.ps", changed)) == STAGES[4:]
    assert make(folder, "--question", "disc.ps", changed).returncode == 1
    assert remade(make(folder, "disc.ps", changed)) == STAGES[4:]
    assert make(folder, "--question", "disc.ps", changed).returncode == 0


def test_options_may_hold_quotes(folder):
    named = "TO_SVG=--color 'black'"
    assert make(folder, "disc.svg", named).returncode == 0
    assert (folder / "disc.to-svg.options").read_text() == "--color 'black'\n"
    assert make(folder, "--question", "disc.svg", named).returncode == 0


def test_clean_keeps_the_kernels_sources():
    env = environment(MAKEFLAGS="")
    told = subprocess.run(["make", "-n", "clean"], cwd=ROOT, env=env, capture_output=True, text=True, check=True)
    words = told.stdout.split()
    assert "penink_cli/geometry/_compiled/predicates.c" in words
    assert not [word for word in words if word.endswith((".py", ".pyx", ".pxd", ".h"))]
