"""Text of tables: rows of whole numbers and words, written and read byte by byte."""

from typing import NamedTuple

from numba import types

from trihex.kernels.actions import ACTIONS, site_after, times_of
from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import APART, HELPER, IN_BOOL, IN_I32, IN_I64, IN_U8, OUT_I64, OUT_U8, declared, kernel

COMMA, NEWLINE, RETURN, MINUS, ZERO = 44, 10, 13, 45, 48
# No row is longer: five numbers of at most 19 digits, a word, and the commas.
LONGEST_ROW = 160
# What `parse_table` answers besides 0, all well.
NO_NUMBER, NO_WORD, TOO_FEW, TOO_MANY = 1, 2, 3, 4


class Spelling(NamedTuple):
    """The words that a column may hold."""

    letters: IN_U8  # those of all words, one after the other
    first: IN_I64  # word w is letters[first[w] : first[w + 1]]


class PlanTable(NamedTuple):
    """What the rows of a plan are made of besides its actions."""

    start: IN_I32  # the site in which each robot starts
    cost: IN_I32  # of each direction
    duration: IN_I32  # of each action, by its byte
    waiting_cost: types.int64
    origin: types.int64  # the site of cell (0, 0)
    pitch: types.int64  # from a row of sites to the next


SPELLING = declared(Spelling)


@APART
def _put_number(text, at, value):
    """Write a number from 0; return where the text goes on."""
    digits = 1
    power = 10
    while power <= value and digits < 19:
        digits += 1
        power *= 10
    for place in range(at + digits - 1, at - 1, -1):
        text[place] = ZERO + value % 10
        value //= 10
    return at + digits


@HELPER
def _put_word(text, at, word, spelling):
    for i in range(spelling.first[word], spelling.first[word + 1]):
        text[at] = spelling.letters[i]
        at += 1
    return at


@HELPER
def _word_of(action, site, directions):
    """Return the word for an action at a site: words are directions by parity, then start, wait, jump."""
    if action == WAIT:
        return 2 * directions + 1
    if action == JUMP:
        return 2 * directions + 2
    return (site & 1) * directions + action


@HELPER
def _price_of(action, table):
    if action == WAIT:
        return table.waiting_cost
    return 0 if action == JUMP else table.cost[action]


@kernel(types.int64(declared(PlanTable), ACTIONS, SPELLING, OUT_I64, OUT_U8))
def write_plan_rows(table, actions, spelling, state, text):
    """Fill `text` with rows ``robot,step,x,y,action,time`` and return its length, 0 when all are written.

    The words are the directions of parity 0, those of parity 1, then start, wait, jump. `state` holds robot, number of
    actions done, site, time and step of where to go on, zeros before the first call.
    """
    directions = actions.offset.shape[1]
    robot, done, site, time, step = state[0], state[1], state[2], state[3], state[4]
    at = types.int64(0)
    while robot < len(table.start) and at + LONGEST_ROW <= len(text):
        if done == 0:
            site = types.int64(table.start[robot])
            time, step = 0, 0
            word = 2 * directions
        else:
            i = actions.first[robot] + done - 1
            action = actions.action[i]
            word = _word_of(action, site, directions)
            times = times_of(robot, action, actions)
            time += _price_of(action, table) * times
            step += table.duration[action] * times
            site = site_after(site, i, actions)
        place = site - table.origin
        for number in (robot, step, place % table.pitch, place // table.pitch):
            at = _put_number(text, at, number)
            text[at] = COMMA
            at += 1
        at = _put_word(text, at, word, spelling)
        text[at] = COMMA
        at = _put_number(text, at + 1, time)
        text[at] = NEWLINE
        at += 1
        done += 1
        if actions.first[robot] + done > actions.first[robot + 1]:
            robot += 1
            done = 0
    state[0], state[1], state[2], state[3], state[4] = robot, done, site, time, step
    return at


@HELPER
def _number_at(text, at):
    """Return a whole number and where it ends; that is where it begins if it is none, or has more than 18 digits."""
    is_negative = text[at] == MINUS
    first = at + is_negative
    end = first
    value = 0
    while text[end] >= ZERO and text[end] < ZERO + 10 and end - first < 19:
        value = value * 10 + (text[end] - ZERO)
        end += 1
    if end == first or end - first > 18:
        return value, at
    return -value if is_negative else value, end


@HELPER
def _word_at(text, at, spelling):
    """Return a word and where it ends; -1 for one that is unknown."""
    end = at
    while text[end] != COMMA and text[end] != NEWLINE and text[end] != RETURN:
        end += 1
    for word in range(len(spelling.first) - 1):
        begin = spelling.first[word]
        if spelling.first[word + 1] - begin == end - at:
            same = at
            while same < end and text[same] == spelling.letters[begin + same - at]:
                same += 1
            if same == end:
                return word, end
    return -1, end


@HELPER
def _read_row(text, at, is_word, spelling, row, state, table):
    """Fill a row of `table`; return what is wrong and where the next row begins.

    ``state[2]`` and ``state[3]`` tell in which column that is, and where it begins.
    """
    columns = len(is_word)
    for column in range(columns):
        state[2], state[3] = column, at
        if is_word[column]:
            value, end = _word_at(text, at, spelling)
            if value < 0:
                return NO_WORD, at
        else:
            value, end = _number_at(text, at)
            if end == at:
                return NO_NUMBER, at
        table[column, row] = value
        at = end
        if column < columns - 1:
            if text[at] != COMMA:
                ends = text[at] == NEWLINE or text[at] == RETURN
                return TOO_FEW if ends else NO_NUMBER, at
            at += 1
    if text[at] == RETURN:
        at += 1
    if text[at] != NEWLINE:
        return TOO_MANY if text[at] == COMMA else NO_NUMBER, at
    return 0, at + 1


@kernel(types.int64(IN_U8, IN_BOOL, SPELLING, types.int64, OUT_I64, types.Array(types.int64, 2, "C")))
def parse_table(text, is_word, spelling, budget, state, table):
    """Read at most `budget` rows of ``table[column, row]`` from `text`; return 0 or what is wrong.

    Columns hold a whole number of at most 18 digits or, where `is_word` says so, one of the words, which comes out as
    its index. `state` holds where to read on and the row, and on return the faulty column and its first byte. Every row
    ends in a line feed.
    """
    at, row = state[0], state[1]
    last_row = row + budget
    if last_row > table.shape[1]:
        last_row = table.shape[1]
    wrong = 0
    while row < last_row and wrong == 0:
        wrong, at = _read_row(text, at, is_word, spelling, row, state, table)
        if wrong == 0:
            row += 1
    state[0], state[1] = at, row
    return wrong
