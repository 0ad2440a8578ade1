"""`trihex prices`: rows, words and a picture; what was interrupted goes on."""

import csv
import signal
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

import trihex as th
from tests.prices.test_prices import crowded_scenario
from trihex.cli import main
from trihex.cli.prices import price_lines
from trihex.formats import PricesJournal

WORLD = "....#...\n##.#.##.\n....#...\n.##..#.D\n....#...\n"
PRICES = ["prices", "world.txt", "--destination", "7,3", "--robots", "12", "--seed", "1"]


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("world.txt").write_text(WORLD.replace("D", "."))
    return tmp_path


def run(*arguments, status=0):
    done = CliRunner().invoke(main, [str(one) for one in arguments])
    assert done.exit_code == status, done.output
    return done.output


def rows_of(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def test_prices_are_told_written_and_drawn(folder):
    out = run(*PRICES, "--out", "p.csv", "--picture", "p.png")
    assert "written: p.csv, p.png" in out
    assert "which is the least" in out and "to open (" in out and "best next door: (" in out
    rows = rows_of("p.csv")
    assert list(rows[0]) == ["x", "y", "kind", "price", "robots", "proven", "most"]
    assert sum(row["kind"] == "barrier" for row in rows) == WORLD.count("#")
    assert {row["proven"] for row in rows} == {"true"}
    assert not list(folder.glob("*.part"))
    with Image.open("p.png") as image:
        assert image.size[0] > 100


def test_work_that_was_interrupted_goes_on(folder):
    run(*PRICES, "--out", "whole.csv")
    out = run(*PRICES, "--out", "p.csv", "--limit-seconds", "1e-9")
    assert "not proven: " in out and "the same command goes on" in out
    first = rows_of("p.csv")
    assert any(row["proven"] == "false" for row in first)
    run(*PRICES, "--out", "p.csv")
    assert Path("p.csv").read_bytes() == Path("whole.csv").read_bytes()
    assert "add --out to be able to go on" in run(*PRICES, "--limit-seconds", "1e-9")


def test_ctrl_c_keeps_what_was_done(folder, monkeypatch):
    run(*PRICES, "--out", "whole.csv")
    note = PricesJournal.note

    def note_and_interrupt(journal, kind, cell, price):
        note(journal, kind, cell, price)
        signal.raise_signal(signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    monkeypatch.setattr(PricesJournal, "note", note_and_interrupt)
    out = run(*PRICES, "--out", "p.csv", status=130)
    assert "written: p.csv" in out and "not known" in out
    assert len(Path("p.csv.part").read_text().splitlines()) == 2
    assert signal.getsignal(signal.SIGINT) == before
    monkeypatch.undo()
    monkeypatch.chdir(folder)
    run(*PRICES, "--out", "p.csv")
    assert Path("p.csv").read_bytes() == Path("whole.csv").read_bytes()


def test_a_door_that_is_not_sought_to_the_end_is_not_proven():
    plan = th.make_plan(crowded_scenario(28), "optimal")
    prices = th.make_prices(plan, kinds="door", stop=lambda: True)
    assert prices.best_door is None and not prices.is_complete
    most = int(prices.most[0])
    assert price_lines(prices)[-1] == f"best next door: not known; none saves more than {most} units of time"
    best = th.make_prices(plan, kinds="door")
    assert best.is_complete and best.most[0] == best.price[0] <= most
    known = {("door", int(best.cell[0])): int(best.price[0])}
    part = th.make_prices(plan, kinds="door", known=known, stop=lambda: True)
    assert part.best_door == best.best_door and part.most[0] >= best.price[0]


def test_only_some_kinds_are_priced(folder):
    run(*PRICES, "--kind", "choke", "--out", "p.csv")
    assert {row["kind"] for row in rows_of("p.csv")} <= {"choke"}


def test_robots_that_cannot_arrive_make_the_status_one(folder):
    Path("world.txt").write_text("..#..\n")
    command = ["prices", "world.txt", "--destination", "4,0", "--robots", "2", "--seed", "1"]
    out = run(*command, status=1)
    assert "barriers: 0 save time to open, 0 save nothing, 1 let more robots arrive\n" in out
    assert "  to open (2, 0) lets 2 more robots arrive\n" in out
    Path("world.txt").write_text("....\n")
    out = run("prices", "world.txt", "--destination", "3,0", "--robots", "3", "--seed", "1", "--kind", "choke")
    assert "1 cut robots off\n  to close (2, 0) cuts 3 robots off, one of which starts there\n" in out


def test_a_journal_keeps_what_was_told_and_knows_its_scenario(tmp_path):
    plan = th.make_plan(crowded_scenario(28), "optimal")
    path = tmp_path / "p.csv.part"
    journal = PricesJournal(path, plan)
    whole = th.make_prices(plan, tell=journal.note)
    with open(path, "a") as file:
        file.write("barrier,3")  # it was being written when the power failed
    again = PricesJournal(path, plan)
    assert len(again.known) > 8
    assert th.make_prices(plan, known=again.known, stop=lambda: True) == whole
    other = th.make_plan(crowded_scenario(1), "optimal")
    with pytest.raises(th.FormatError, match=r"p\.csv\.part is of the prices of another scenario; remove it"):
        PricesJournal(path, other)
    path.write_text(path.read_text().split("\n")[0] + "\nwall,3,x\n")
    with pytest.raises(th.FormatError, match=r"p\.csv\.part:2: must be kind,cell,price, not 'wall,3,x'"):
        PricesJournal(path, plan)


def test_prices_in_metres_have_seconds(tmp_path):
    area = th.Area(th.Tessellation("square", "edge"), [[0, 1, 0], [0, 1, 0], [0, 0, 0]], frame=th.Frame(20.0))
    plan = th.make_plan(th.Scenario(area, [(2, 0)], [(0, 0), (0, 1)], following="allow"), "optimal")
    prices = th.make_prices(plan)
    th.write_prices(prices, tmp_path / "p.csv", speed=2.0)
    rows = rows_of(tmp_path / "p.csv")
    assert [row["seconds"] for row in rows if row["kind"] == "barrier"] == ["60.0", "40.0"]
    assert prices.told(60, 2.0) == "1 min 0 s" and prices.told(10, 2.0) == "10 s" and prices.told(36000) == "20 h 0 min"


def test_barriers_that_save_more_are_drawn_darker():
    area = th.Area(th.Tessellation("square", "edge"), [[0, 1, 0], [0, 1, 0], [0, 0, 0]])
    plan = th.make_plan(th.Scenario(area, [(2, 0)], [(0, 0), (0, 1)]), "optimal")
    picture = th.picture_of_prices(th.make_prices(plan, kinds="barrier"), width=300)
    cells = picture.scene.colour_of_cell
    assert cells[0, 1] > cells[1, 1] > 0
    assert picture.scene.legend[0].words == "saved if open" and "units of time" in picture.scene.subtitle
    with_door = th.picture_of_prices(th.make_prices(plan), width=300)
    assert any("best next door" in key.words for key in with_door.scene.legend)
    assert not np.array_equal(picture.to_array(), with_door.to_array())
    assert not any("who can arrive" in key.words for key in picture.scene.legend)
    row = th.Scenario(th.Area("square", [[0, 0, 0]]), destinations=[(2, 0)], robots=[(0, 0)])
    cut_off = th.picture_of_prices(th.make_prices(th.make_plan(row, "optimal")), width=300).scene
    assert cut_off.legend[0].words == "changes who can arrive"
    assert cut_off.colours[cut_off.colour_of_cell[0, 1]].tolist() == list(cut_off.legend[0].colour)
    assert "Prices" in th.draw_prices(th.make_prices(plan)).get_title()
