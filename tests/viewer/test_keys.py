"""The space bar plays whatever was clicked last; who came by the keyboard presses what is focused."""

import numpy as np
import pytest

import trihex as th
from trihex.planners import make_plan


@pytest.fixture
def shown(open_viewer):
    scenario = th.Scenario(th.Area("square", np.zeros((4, 40)), "corridor"), [(39, 2)], [(0, 1), (3, 2)])
    shown = open_viewer(make_plan(scenario, "greedy"))
    shown.page.get_by_label("Steps per second").fill("0")
    return shown


def is_playing(shown):
    return shown.ask("app.clock.isPlaying")


@pytest.mark.parametrize(
    "click",
    [
        lambda page: page.get_by_role("button", name="Wall").click(),
        lambda page: page.get_by_label("Colours").click(),
        lambda page: page.get_by_label("Robots", exact=True).click(),
        lambda page: page.locator("summary", has_text="Result").click(),
        lambda page: page.locator(".scrub").click(position={"x": 3, "y": 5}),
        lambda page: page.get_by_label("Planner", exact=True).select_option("greedy"),
        lambda page: page.locator("canvas").first.click(position={"x": 3, "y": 3}),
    ],
    ids=["button", "box", "field", "summary", "slider", "menu", "canvas"],
)
def test_the_space_bar_plays_whatever_was_clicked_last(shown, click):
    click(shown.page)
    before = shown.page.locator("[aria-pressed=true], :checked, details[open]").count()
    shown.page.keyboard.press("Space")
    assert is_playing(shown)
    assert shown.page.locator("[aria-pressed=true], :checked, details[open]").count() == before
    shown.page.keyboard.press("Space")
    assert not is_playing(shown) and shown.faults == []


def test_who_came_by_the_keyboard_presses_what_is_focused(shown):
    page = shown.page
    page.get_by_label("Colours").click()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.parentElement.textContent") == "Arrows"
    page.keyboard.press("Space")
    assert page.get_by_label("Arrows").is_checked() and not is_playing(shown)
    page.mouse.click(*map(float, shown.place(20, 3)))
    page.keyboard.press("Space")
    assert page.get_by_label("Arrows").is_checked() and is_playing(shown)


def test_home_and_end(shown):
    page = shown.page
    page.keyboard.press("End")
    assert shown.ask("app.clock.at === app.steps")
    page.keyboard.press("Home")
    assert shown.ask("app.clock.at") == 0
