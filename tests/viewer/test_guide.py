"""The guided minute: offered once, gone at a wish, and it shows what it says."""

import pytest

GUIDE = "A guided minute"


@pytest.mark.parametrize(("width", "height", "scheme"), [(1400, 900, "light"), (390, 844, "dark")])
def test_four_steps_show_the_field_robots_the_optimum_and_a_live_run(open_viewer, width, height, scheme):
    shown = open_viewer(viewport={"width": width, "height": height}, color_scheme=scheme)
    guide = shown.page.get_by_role("region", name=GUIDE)
    shown.wait("app.guide.at === 0")
    assert "New here?" in guide.inner_text()
    shown.press("Start")
    shown.wait("app.growth && app.growth.generation > 5")
    assert "1 of 4" in guide.inner_text()
    shown.keep(f"guide-{width}-1")
    shown.press("Next")
    shown.wait("app.runs[0] && app.clock.at > 1")
    assert shown.ask("app.runs[0].summary.planner") == "fcost" and shown.ask("app.panes[0].values !== null")
    shown.keep(f"guide-{width}-2")
    box = shown.page.locator("canvas").first.bounding_box()
    assert box["y"] >= 0 and box["y"] + box["height"] <= height  # what plays is in sight
    shown.press("Next")
    shown.wait("app.runs[1] && app.clock.isPlaying && app.runs[1].summary.optimal")
    shown.keep(f"guide-{width}-3")
    shown.press("Next")
    shown.wait("app.live && app.live.last.step > 2")
    assert shown.ask("app.tools.chosen") == "wall" and not guide.get_by_role("button", name="Skip").is_visible()
    free = shown.ask("app.doc.barriers.findIndex((b, cell) => !b && cell > 40 && !app.doc.robots.includes(cell))")
    shown.click(free % 48, free // 48)
    shown.wait(f"app.doc.barriers[{free}]")
    shown.keep(f"guide-{width}-4")
    shown.press("Done")
    assert not guide.is_visible()
    shown.page.reload()
    shown.wait("app.doc && !app.making")
    assert not guide.is_visible() and shown.faults == []


def test_it_can_be_skipped_and_had_again(open_viewer):
    shown = open_viewer()
    guide = shown.page.get_by_role("region", name=GUIDE)
    shown.wait("app.guide.at === 0")
    shown.press("Skip")
    assert not guide.is_visible()
    shown.page.reload()
    shown.wait("app.doc && !app.making")
    assert not guide.is_visible()
    shown.press("Help")
    shown.press("Show me: a guided minute")
    shown.wait("app.growth && app.growth.generation > 1")
    assert "1 of 4" in guide.inner_text()


def test_who_begins_to_paint_is_left_alone(open_viewer):
    shown = open_viewer()
    shown.wait("app.guide.at === 0")
    free = shown.ask("app.doc.barriers.findIndex((b, cell) => !b && !app.doc.robots.includes(cell))")
    shown.click(free % 48, free // 48)
    assert not shown.page.get_by_role("region", name=GUIDE).is_visible()
    assert shown.ask(f"app.doc.barriers[{free}]") == 1
