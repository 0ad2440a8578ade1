"""Ground: whether a move is open, whoever may be there."""

from trihex.judging.kernels.deeds import NO_VERTEX
from trihex.judging.kernels.findings import CORNER, NONE, ONTO_BARRIER, note
from trihex.judging.kernels.law import ALLOW, BARRIER, is_corner_closed
from trihex.kernels.codes import WAIT
from trihex.kernels.signatures import HELPER


@HELPER
def judge_ground(deed, law, place, findings):
    """Judge whether barriers or the corners of them stand in the way of a robot."""
    is_onto_barrier = deed.onto >= BARRIER
    if is_onto_barrier and deed.action != WAIT:
        note(findings, deed.step, ONTO_BARRIER, (deed.robot, NONE), (deed.here, deed.target, NONE, NONE))
    if deed.vertex != NO_VERTEX and law.corner_rule != ALLOW and not is_onto_barrier:
        if is_corner_closed(deed.here, deed.target, deed.vertex, place, law):
            note(findings, deed.step, CORNER, (deed.robot, NONE), (deed.here, deed.target, NONE, NONE))
