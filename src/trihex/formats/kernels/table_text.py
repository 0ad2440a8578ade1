"""Text of tables: rows of whole numbers and words, written and read byte by byte."""

from numba import njit, types

from trihex.kernels.codes import JUMP, WAIT
from trihex.kernels.signatures import IN_BOOL, IN_I32, IN_I64, IN_U8, OUT_I64, OUT_U8, TABLE_I32

COMMA, NEWLINE, RETURN, MINUS, ZERO = 44, 10, 13, 45, 48
# No row is longer: five numbers of at most 19 digits, a word, and the commas.
LONGEST_ROW = 160
# What `parse_table` answers besides 0, all well.
NO_NUMBER, NO_WORD, TOO_FEW, TOO_MANY = 1, 2, 3, 4


@njit(nogil=True)
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


@njit(nogil=True)
def _put_word(text, at, letters, first, last):
    for i in range(first, last):
        text[at] = letters[i]
        at += 1
    return at


@njit(
    types.int64(
        IN_I32,
        IN_U8,
        IN_I64,
        TABLE_I32,
        IN_I32,
        types.int64,
        IN_I64,
        IN_I32,
        types.int64,
        types.int64,
        IN_U8,
        IN_I64,
        OUT_I64,
        OUT_U8,
    ),
    cache=True,
    nogil=True,
)
def write_plan_rows(
    start,
    actions,
    first_action,
    offset,
    cost,
    waiting,
    jump_at,
    jump_to,
    origin,
    pitch,
    letters,
    first_letter,
    state,
    text,
):
    """Fill `text` with rows ``robot,step,x,y,action,time`` and return its length, 0 when all are written.

    Word w is ``letters[first_letter[w] : first_letter[w + 1]]``: the directions of parity 0, those of parity 1, then
    start, wait, jump. `state` holds robot, step, site, time and next jump, zeros before the first call.
    """
    directions = offset.shape[1]
    robot, step, site, time, jump = state[0], state[1], state[2], state[3], state[4]
    at = 0
    while robot < len(start) and at + LONGEST_ROW <= len(text):
        if step == 0:
            site = start[robot]
            time = 0
            word = 2 * directions
        else:
            i = first_action[robot] + step - 1
            action = actions[i]
            if action == WAIT:
                time += waiting
                word = 2 * directions + 1
            elif action == JUMP:
                while jump_at[jump] < i:
                    jump += 1
                site = jump_to[jump]
                word = 2 * directions + 2
            else:
                word = (site & 1) * directions + action
                time += cost[action]
                site += offset[site & 1, action]
        place = site - origin
        at = _put_number(text, at, robot)
        text[at] = COMMA
        at = _put_number(text, at + 1, step)
        text[at] = COMMA
        at = _put_number(text, at + 1, place % pitch)
        text[at] = COMMA
        at = _put_number(text, at + 1, place // pitch)
        text[at] = COMMA
        at = _put_word(text, at + 1, letters, first_letter[word], first_letter[word + 1])
        text[at] = COMMA
        at = _put_number(text, at + 1, time)
        text[at] = NEWLINE
        at += 1
        if first_action[robot] + step == first_action[robot + 1]:
            robot += 1
            step = 0
        else:
            step += 1
    state[0], state[1], state[2], state[3], state[4] = robot, step, site, time, jump
    return at


@njit(
    types.int64(IN_U8, IN_BOOL, IN_U8, IN_I64, types.int64, OUT_I64, types.Array(types.int64, 2, "C")),
    cache=True,
    nogil=True,
)
def parse_table(text, is_word, letters, first_letter, budget, state, table):
    """Read at most `budget` rows of ``table[column, row]`` from `text`; return 0 or what is wrong.

    Columns hold a whole number of at most 18 digits or, where `is_word` says so, one of the words, which comes out as
    its index. `state` holds where to read on and the row, and on return the faulty column and its first byte. Every row
    ends in a line feed.
    """
    at, row = state[0], state[1]
    columns = len(is_word)
    words = len(first_letter) - 1
    last_row = min(row + budget, table.shape[1])
    while row < last_row:
        for column in range(columns):
            begin = at
            state[0], state[1], state[2], state[3] = at, row, column, begin
            if is_word[column]:
                while text[at] != COMMA and text[at] != NEWLINE and text[at] != RETURN:
                    at += 1
                found = -1
                for word in range(words):
                    length = first_letter[word + 1] - first_letter[word]
                    if length == at - begin:
                        same = 0
                        while same < length and text[begin + same] == letters[first_letter[word] + same]:
                            same += 1
                        if same == length:
                            found = word
                            break
                if found < 0:
                    return NO_WORD
                table[column, row] = found
            else:
                is_negative = text[at] == MINUS
                if is_negative:
                    at += 1
                first_digit = at
                value = 0
                while text[at] >= ZERO and text[at] < ZERO + 10 and at - first_digit < 19:
                    value = value * 10 + (text[at] - ZERO)
                    at += 1
                if at == first_digit or at - first_digit > 18:
                    return NO_NUMBER
                table[column, row] = -value if is_negative else value
            if column < columns - 1:
                if text[at] != COMMA:
                    ends = text[at] == NEWLINE or text[at] == RETURN
                    return TOO_FEW if ends else NO_NUMBER
                at += 1
        if text[at] == RETURN:
            at += 1
        if text[at] != NEWLINE:
            return TOO_MANY if text[at] == COMMA else NO_NUMBER
        at += 1
        row += 1
    state[0], state[1] = at, row
    return 0
