"""Heap: what is to be looked at next, the least first, with what decides between equal ones."""

from typing import NamedTuple

from trihex.kernels.signatures import HELPER, OUT_I32, OUT_I64, declared


class Heap(NamedTuple):
    """Entries in the order of a binary heap; how many there are is counted by who uses it."""

    key: OUT_I64  # the entry of the least key comes first
    tie: OUT_I32  # of equal keys, that of the least tie; equal in both, they come in any order, but always the same
    item: OUT_I32  # what the entry stands for


HEAP = declared(Heap)


@HELPER
def push(heap, size, key, tie, item):
    """Add an entry to a heap of `size` entries that has room for one more."""
    at = size
    while at > 0:
        above = (at - 1) >> 1
        if key > heap.key[above] or (key == heap.key[above] and tie >= heap.tie[above]):
            break
        _set(heap, at, heap.key[above], heap.tie[above], heap.item[above])
        at = above
    _set(heap, at, key, tie, item)


@HELPER
def drop_first(heap, size):
    """Remove the first of `size` entries: the last one takes its place and sinks."""
    last = size - 1
    key, tie = heap.key[last], heap.tie[last]
    at = 0
    while 2 * at + 1 < last:
        child = 2 * at + 1
        if child + 1 < last and _is_before(heap, child + 1, heap.key[child], heap.tie[child]):
            child += 1
        if not _is_before(heap, child, key, tie):
            break
        _set(heap, at, heap.key[child], heap.tie[child], heap.item[child])
        at = child
    _set(heap, at, key, tie, heap.item[last])


@HELPER
def _is_before(heap, at, key, tie):
    return heap.key[at] < key or (heap.key[at] == key and heap.tie[at] < tie)


@HELPER
def _set(heap, at, key, tie, item):
    heap.key[at] = key
    heap.tie[at] = tie
    heap.item[at] = item
