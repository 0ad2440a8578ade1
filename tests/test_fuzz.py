"""Damaged files: what fuzzing found once, and some new ones each time; the long run is ``python -m fuzz``."""

from pathlib import Path
from random import Random

import pytest
from fuzz.mutations import MUTATIONS, mutate
from fuzz.seeds import make_seeds
from fuzz.targets import TARGETS, outcome_of

from tests.sweeps import swept

CORPUS = Path(__file__).parents[1] / "fuzz" / "corpus"


@pytest.fixture(scope="module")
def seeds():
    return make_seeds()


@pytest.fixture
def folder(tmp_path, seeds):
    for name in ("house.pgm", "house.yaml", "yard.map"):
        (tmp_path / name).write_bytes(seeds[name])
    return tmp_path


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*/*")), ids=lambda path: f"{path.parent.name}/{path.name}")
def test_what_was_found_is_refused_or_read(folder, path):
    bad = folder / ("bad" + Path(path.parent.name).suffix)
    bad.write_bytes(path.read_bytes())
    assert outcome_of(TARGETS[path.parent.name], bad).word != "fault"


@pytest.mark.parametrize("name", TARGETS)
def test_damaged_files_are_refused_or_read(folder, seeds, name):
    good = folder / ("good" + Path(name).suffix)
    good.write_bytes(seeds[name])
    TARGETS[name](good)  # the seed itself is read
    before = sorted(path.name for path in folder.iterdir())
    for number in range(swept(30, 5)):
        damaged = mutate(seeds[name], Random(f"test/{name}/{number}"), list(seeds.values()))
        good.write_bytes(damaged[:20_000])
        outcome = outcome_of(TARGETS[name], good)
        assert outcome.word != "fault", f"file {number}: {outcome.text}"
    assert sorted(path.name for path in folder.iterdir()) == before


@pytest.mark.parametrize("mutation", dict.fromkeys(MUTATIONS), ids=lambda mutation: mutation.__name__)
def test_mutations_are_repeatable_and_do_something(seeds, mutation):
    others = list(seeds.values())
    one = [mutation(seeds["yard.toml"], Random(seed), others) for seed in range(10)]
    assert one == [mutation(seeds["yard.toml"], Random(seed), others) for seed in range(10)]
    assert any(data != seeds["yard.toml"] for data in one)


@pytest.mark.parametrize("kind", ["loop", "folder", "nowhere", "device", "link"])
@pytest.mark.parametrize("name", ["house.yaml", "plan.npz", "starts.csv"])
def test_links_and_devices_are_refused_with_their_name(folder, seeds, kind, name):
    bad = folder / ("bad" + Path(name).suffix)
    target = {"loop": bad, "folder": folder, "nowhere": folder / "none", "device": Path("/dev/zero")}.get(kind)
    if kind == "link":
        target = folder / "really"
        target.write_bytes(seeds[name])
    bad.symlink_to(target)
    assert outcome_of(TARGETS[name], bad).word != "fault"
    if kind != "link":
        with pytest.raises((OSError, ValueError), match="bad"):
            TARGETS[name](bad)
