"""Task 10.3, public checks."""

import numpy as np
from photograd_course.grading import Array, agree, checks_for
from photograd_course.grading.failures import StudentFailure

from .common import recognized, same_counts

check = checks_for(calls=("voxel_hash_insert",))


def some_voxels(t, count, reach=6):
    """Different voxels (count, 3), below zero as well."""
    voxels = np.unique(t.rng.integers(-reach, reach, (3 * count, 3)), axis=0)
    return t.rng.permutation(voxels)[:count]


def crowd(t, count, slots, slot):
    """Different voxels (count, 3) that all begin at one slot, no two with an index in common."""
    found = []
    while len(found) < count:
        some = t.rng.integers(-200, 200, (40 * slots, 3))
        for voxel in some[first_slot(some, slots) == slot]:
            if len(found) < count and all((voxel != each).all() for each in found):
                found.append(voxel)
    return np.array(found)


def free_table(slots):
    table = np.zeros((slots, 4), np.int64)
    table[:, 3] = -1
    return table


def first_slot(voxels, slots):
    x, y, z = voxels.T
    return (x * 73856093 ^ y * 19349663 ^ z * 83492791) % slots


# What NumPy and Python say of mistakes that have nothing to do with the room in a table.
ELSEWHERE = ("ambiguous", "broadcast", "shape", "convert", "unpack", "invalid", "sequence", "zip()")
AROUND = "after the last slot comes slot 0: (9) is mod S"
THERE = "the voxel is there already: overwrite its slot, take no second one"


def insert(t, table, voxels, rows):
    """The table with these voxels, for whom there is room."""
    try:
        return t.call("voxel_hash_insert", table, voxels, rows, returns=Array(table.shape, "i8"))
    except StudentFailure as failure:
        kind = failure.private.partition(":")[0]
        told = {"IndexError": "out of" in failure.private, "ValueError": True}.get(kind, False)
        told = told and not any(word in failure.private for word in ELSEWHERE)
        if failure.reason != "raised" or not told or t.check.visibility != "public":
            raise
        # With a slot for each, even for those that come twice, only the way around is left.
        twice = kind == "ValueError" and (table[:, 3] >= 0).sum() + len(voxels) > len(table)
        raise recognized(failure, ", though there is room", THERE if twice else AROUND) from None


def require_sound(t, table, voxels, rows):
    """Each voxel stands in the table once, with its row, and a search gets to it."""
    taken = np.flatnonzero(table[:, 3] >= 0)
    t.require(
        len(taken) == len(voxels),
        f"{len(taken)} slots are taken by {len(voxels)} voxels",
        hint=THERE if len(taken) > len(voxels) else "",
    )
    where = {
        tuple(entry[:3]): int(slot)
        for slot, entry in zip(taken, table[taken].tolist(), strict=True)
    }
    starts = first_slot(voxels, len(table)).tolist()
    for voxel, row, start in zip(voxels.tolist(), rows.tolist(), starts, strict=True):
        slot = where.get(tuple(voxel))
        t.require(slot is not None, f"voxel {voxel} is not in the table")
        own = int(table[slot, 3])
        t.require(own == row, f"voxel {voxel} has the row {own}, not {row}")
        between = (start + np.arange((slot - start) % len(table))) % len(table)
        t.require(
            bool((table[between, 3] >= 0).all()),
            f"a free slot lies between the first slot of {voxel} and where it is: "
            "a search ends there",
        )


@check(
    "10.3.found",
    points=3,
    hint="handout, equation (9): the first free slot from the voxel's own onward",
    sole="asks what a table is for: voxel in, row out",
)
def what_was_put_in_is_found(t):
    """Voxels are found with their rows, in tables almost empty and almost full; others are not."""
    cases = [(some_voxels(t, count), slots) for count, slots in ((1, 3), (30, 61), (30, 31))]
    cases += [(crowd(t, count, 7, 5), 7) for count in (6, 7)]
    for voxels, slots in cases:
        count = len(voxels)
        rows = t.rng.permutation(5 * count)[:count] + 1
        rows[0] = 0  # a row as good as any
        table = insert(t, free_table(slots), voxels, rows)
        others = some_voxels(t, 20) + 300
        found = t.call(
            "voxel_hash_find",
            table,
            np.concatenate([voxels, others]),
            returns=Array((count + 20,), "i8"),
        )
        same_counts(t, "rows that are found", found, np.append(rows, np.full(20, -1)))
        require_sound(t, table, voxels, rows)


@check(
    "10.3.again",
    points=3,
    hint="a slot that holds the very same voxel is as good as a free one",
    sole="a voxel that comes again is not a new one",
)
def a_voxel_that_comes_again_gets_its_new_row(t):
    """Put in twice, a voxel takes one slot and has the later row; the others keep theirs."""
    voxels, rows = crowd(t, 8, 11, 9), np.arange(8)
    table = insert(t, free_table(11), voxels[:6], rows[:6])
    again = np.concatenate([voxels[3:], voxels[4:6]])
    table = insert(t, table, again, np.concatenate([rows[3:] + 100, [7, 8]]))
    expected = np.concatenate([rows[:3], rows[3:] + 100])
    expected[4:6] = 7, 8
    require_sound(t, table, voxels, expected)
    pair = crowd(t, 2, 2, 0)
    full = insert(t, free_table(2), pair, np.array([3, 4]))
    require_sound(t, insert(t, full, pair[::-1], np.array([6, 5])), pair, np.array([5, 6]))


@check(
    "10.3.room",
    points=2,
    hint="count the slots that were looked at: after all of them, raise ValueError",
)
def a_full_table_says_so(t):
    """A new voxel for a table without a free slot is refused with ValueError."""
    for slots in (1, 5):
        voxels = crowd(t, slots + 1, slots, slots - 1)
        table = insert(t, free_table(slots), voxels[:slots], np.arange(slots))
        require_sound(t, table, voxels[:slots], np.arange(slots))
        t.refuses("voxel_hash_insert", table, voxels[slots:], np.array([9]), error="ValueError")


@check(
    "10.3.kept",
    points=1,
    hint="copy the table first",
    sole="what students can run; hidden checks find its mistakes as well",
)
def the_old_table_stays(t):
    """Voxels inserted in a table are not in the table that was given."""
    voxels, rows = some_voxels(t, 10), np.arange(5)
    got = t.call(
        "adapters.insert_after",
        free_table(11),
        voxels[:5],
        voxels[5:],
        rows,
        returns=Array((11, 4), "i8"),
    )
    same = agree(got, insert(t, free_table(11), voxels[5:], rows))
    t.require(same, "voxel_hash_insert has written into the table that it was given")
