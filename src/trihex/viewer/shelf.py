"""Shelf: the plans, live runs and fields that a desk keeps, so that a page need only name them."""

from __future__ import annotations

from collections import OrderedDict, deque

from trihex.areas import Scenario
from trihex.bounds import LowerBound
from trihex.errors import FormatError
from trihex.fields import NScheme, make_n_scheme
from trihex.judging import Report
from trihex.viewer.live import Live

_MOST_PLANS = 8
_MOST_LIVES = 2
_MOST_N_SCHEMES = 4
_MOST_ACTIONS = 2**29  # of all plans together


class Shelf:
    """Keeps the last of each kind, plans and live runs by name; what is over the limits goes, the oldest first."""

    def __init__(self) -> None:
        self._reports: OrderedDict[str, Report] = OrderedDict()
        self._lives: OrderedDict[str, Live] = OrderedDict()
        self._n_schemes: deque[NScheme] = deque(maxlen=_MOST_N_SCHEMES)
        self._plans_made = self._runs_made = 0

    @property
    def last_report(self) -> Report | None:
        """The report of the plan that was put here last."""
        return next(reversed(self._reports.values())) if self._reports else None

    @property
    def last_live(self) -> Live | None:
        """The live run that was put here last."""
        return next(reversed(self._lives.values())) if self._lives else None

    def put_report(self, report: Report) -> str:
        """Keep a plan with its report, and return the name that it gets."""
        self._plans_made += 1
        name = f"plan-{self._plans_made}"
        self._reports[name] = report
        while len(self._reports) > 1 and (
            len(self._reports) > _MOST_PLANS
            or sum(kept.plan.actions.size for kept in self._reports.values()) > _MOST_ACTIONS
        ):
            self._reports.popitem(last=False)
        return name

    def replace_report(self, name: str, report: Report) -> None:
        """Keep a better report of the plan called `name`."""
        self._reports[name] = report

    def report(self, name: str) -> Report:
        """Return the report of a plan, or raise FormatError if it is not kept any more."""
        if name not in self._reports:
            raise FormatError("this plan is not kept any more: plan again")
        return self._reports[name]

    def put_live(self, live: Live) -> str:
        """Keep a live run, and return the name that it gets."""
        self._runs_made += 1
        name = f"live-{self._runs_made}"
        self._lives[name] = live
        while len(self._lives) > _MOST_LIVES:
            self._lives.popitem(last=False)
        return name

    def live(self, name: str) -> Live:
        """Return a live run, or raise FormatError if it is not kept any more."""
        if name not in self._lives:
            raise FormatError("this live run is not kept any more: run again")
        return self._lives[name]

    def n_scheme(self, scenario: Scenario) -> NScheme:
        """Return the N-scheme of a scenario, made if it is not here."""
        for kept in list(self._n_schemes):
            if kept.scenario == scenario:
                return kept
        n_scheme = make_n_scheme(scenario)
        self._n_schemes.append(n_scheme)
        return n_scheme

    def optimum(self, scenario: Scenario) -> LowerBound | None:
        """Return the least total time of a scenario, if a plan that is kept has proven it."""
        for report in self._reports.values():
            if report.optimal and report.plan.scenario == scenario:
                return LowerBound("optimum", report.total_time)
        return None
