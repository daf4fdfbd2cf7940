# cython: language_level=3, boundscheck=False, wraparound=False, cdivision=True
"""2-opt and Or-opt on a tour of strokes that may be drawn from either end.

The open path is closed by one stroke more, number n, which is at no distance from anything; so
its two ends are as free as everything else, and of every reversal the shorter side can be done.
A stroke's ends are the points 2s (its start) and 2s + 1; flips[s] says it is drawn backwards.

     2-opt    … s │ b … t │ u …      becomes   … s  t … b  u …    (the middle drawn backwards)
     Or-opt   up to three strokes in a row move between two others, either way round.

Candidates come from the nearest neighbours of each end, and a stroke is looked at again only
when one of its links has changed. Where it ends is a count of steps, not a clock, so that the
bytes are the same on every machine.
"""

import cython
from cython.cimports.libc.math import sqrt

COMPILED = cython.compiled

LONGEST = cython.declare(cython.int, 50000)  # no longer stretch is moved: it would cost more than it brings
CHAIN = cython.declare(cython.int, 3)


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def _d(points: cython.p_const_double, last: cython.int, a: cython.int, b: cython.int) -> cython.double:
    """Distance between two ends; none where either belongs to the stroke that closes the tour."""
    x: cython.double
    y: cython.double
    if a >= last or b >= last:
        return 0.0
    x = points[2 * a] - points[2 * b]
    y = points[2 * a + 1] - points[2 * b + 1]
    return sqrt(x * x + y * y)


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def _either(points: cython.p_const_double, c: cython.int, wanted: cython.int) -> cython.int:
    """The end wanted, if that is the candidate or, the stroke being a dot, as good as it; else -1."""
    if c == wanted or (points[2 * c] == points[2 * wanted] and points[2 * c + 1] == points[2 * wanted + 1]):
        return wanted
    return -1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _reverse(
    tour: cython.p_int, place: cython.p_int, flips: cython.p_uchar, n: cython.int, i: cython.int, j: cython.int
) -> cython.int:
    """Draw places i … j (around the end, if j < i) backwards, or all others, whichever is less work."""
    length: cython.int = j - i + 1 if j >= i else j - i + 1 + n
    k: cython.int
    a: cython.int
    b: cython.int
    if 2 * length > n:
        k = i
        i = j + 1 if j + 1 < n else 0
        j = k - 1 if k > 0 else n - 1
        length = n - length
    if length > LONGEST:
        return -1
    for _ in range((length + 1) // 2):
        a = tour[i]
        b = tour[j]
        tour[i] = b
        place[b] = i
        flips[b] ^= 1
        if a != b:
            tour[j] = a
            place[a] = j
            flips[a] ^= 1
        i = i + 1 if i + 1 < n else 0
        j = j - 1 if j > 0 else n - 1
    return length + 1


@cython.cfunc
@cython.nogil
@cython.exceptval(check=False)
def _move(
    tour: cython.p_int,
    place: cython.p_int,
    flips: cython.p_uchar,
    n: cython.int,
    i: cython.int,
    length: cython.int,
    to: cython.int,
    backwards: cython.bint,
) -> cython.int:
    """Move the `length` strokes from place i on to behind the stroke at place `to`, which is not one of them."""
    chain = cython.declare(cython.int[8])
    k: cython.int
    stroke: cython.int
    # Strokes between the chain and its goal, going on; the others lie between going back.
    ahead: cython.int = to - (i + length - 1)
    behind: cython.int
    source: cython.int
    if ahead < 0:
        ahead += n
    if ahead >= n:
        ahead -= n
    behind = n - length - ahead
    if min(ahead, behind) > LONGEST:
        return -1
    for k in range(length):
        chain[k] = tour[(i + k) % n]
    if ahead <= behind:
        for k in range(ahead):
            source = i + length + k
            if source >= n:
                source -= n
            if source >= n:
                source -= n
            stroke = tour[source]
            source = source - length if source >= length else source - length + n
            tour[source] = stroke
            place[stroke] = source
        i = (i + ahead) % n
    else:
        for k in range(behind):
            source = i - 1 - k
            if source < 0:
                source += n
            stroke = tour[source]
            source = source + length if source + length < n else source + length - n
            tour[source] = stroke
            place[stroke] = source
        i = i - behind
        if i < 0:
            i += n
    for k in range(length):
        stroke = chain[length - 1 - k] if backwards else chain[k]
        if backwards:
            flips[stroke] ^= 1
        tour[(i + k) % n] = stroke
        place[stroke] = (i + k) % n
    return min(ahead, behind) + length


@cython.cfunc
@cython.nogil
@cython.inline
@cython.exceptval(check=False)
def _push(
    queue: cython.p_int, waiting: cython.p_uchar, size: cython.int, tail: cython.p_int, stroke: cython.int
) -> cython.int:
    if not waiting[stroke]:
        waiting[stroke] = 1
        queue[tail[0]] = stroke
        tail[0] = tail[0] + 1 if tail[0] + 1 < size else 0
    return 0


def improve(
    points: cython.const[cython.double][:, ::1],
    near: cython.const[cython.int][:, ::1],
    tour: cython.int[::1],
    place: cython.int[::1],
    flips: cython.uchar[::1],
    queue: cython.int[::1],
    waiting: cython.uchar[::1],
    state: cython.longlong[::1],
    budget: cython.longlong,
    stop: cython.longlong,
) -> int:
    """Shorten a closed tour in place until nothing helps, or no more than `stop` of the `budget` of steps is left.

    Returns the steps left. Called again with the same arrays, and what was left, it goes on as if it had not stopped.

    points (2n, 2), near (2n, k) indices of ends, nearest first, -1 for none.
    tour, place, flips (n + 1,): with stroke n closing it. queue, waiting (n + 1,): the strokes to look at, in the order
    of the tour at first, and 1 for each that is in the queue. state (3,): the queue's head and tail, strokes looked at.
    """
    n: cython.int = tour.shape[0]
    last: cython.int = 2 * (n - 1)
    k_most: cython.int = near.shape[1]
    p: cython.p_const_double = cython.address(points[0, 0])
    t: cython.p_int = cython.address(tour[0])
    at: cython.p_int = cython.address(place[0])
    f: cython.p_uchar = cython.address(flips[0])
    q: cython.p_int = cython.address(queue[0])
    w: cython.p_uchar = cython.address(waiting[0])
    head: cython.int = cython.cast(cython.int, state[0])
    tail: cython.int = cython.cast(cython.int, state[1])
    looked: cython.longlong = state[2]
    i: cython.int
    s: cython.int
    e: cython.int
    before: cython.int
    after: cython.int
    other: cython.int
    beside: cython.int
    a: cython.int
    c: cython.int
    k: cython.int
    way: cython.int
    length: cython.int
    steps: cython.int
    gain: cython.double
    reach: cython.double
    saved: cython.double
    eps: cython.double = 1e-7
    better: cython.bint
    inside: cython.bint
    goal: cython.int
    backwards: cython.bint
    if n < 4:
        return budget
    with cython.nogil:
        while w[q[head]] and budget > stop:
            looked += 1
            s = q[head]
            w[s] = 0
            head = head + 1 if head + 1 < n else 0
            if s == n - 1:
                continue
            better = True
            while better and budget > 0:
                better = False
                # 2-opt, at the link behind s (way 0) and before it (way 1)
                for way in range(2):
                    if way == 0:
                        a = 2 * s + 1 - f[s]
                        other = t[at[s] + 1 if at[s] + 1 < n else 0]
                        e = 2 * other + f[other]
                    else:
                        a = 2 * s + f[s]
                        other = t[at[s] - 1 if at[s] > 0 else n - 1]
                        e = 2 * other + 1 - f[other]
                    reach = _d(p, last, a, e)
                    for k in range(k_most):
                        c = near[a, k]
                        budget -= 1
                        if c < 0:
                            break
                        gain = reach - _d(p, last, a, c)
                        if gain <= eps:
                            break
                        beside = c // 2
                        if way == 0:
                            c = _either(p, c, 2 * beside + 1 - f[beside])
                            if c < 0:
                                continue
                            after = t[at[beside] + 1 if at[beside] + 1 < n else 0]
                            i = 2 * after + f[after]
                        else:
                            c = _either(p, c, 2 * beside + f[beside])
                            if c < 0:
                                continue
                            after = t[at[beside] - 1 if at[beside] > 0 else n - 1]
                            i = 2 * after + 1 - f[after]
                        gain += _d(p, last, c, i) - _d(p, last, e, i)
                        if gain <= eps:
                            continue
                        if way == 0:
                            steps = _reverse(t, at, f, n, at[other], at[beside])
                        else:
                            steps = _reverse(t, at, f, n, at[s], at[after])
                        if steps < 0:
                            continue
                        budget -= steps
                        _push(q, w, n, cython.address(tail), other)
                        _push(q, w, n, cython.address(tail), beside)
                        _push(q, w, n, cython.address(tail), after)
                        better = True
                        break
                    if better:
                        break
                if better:
                    continue
                # Or-opt: the chain from s to e, `length` strokes, elsewhere
                e = s
                for length in range(1, CHAIN + 1):
                    if length > 1:
                        e = t[at[e] + 1 if at[e] + 1 < n else 0]
                    if e == n - 1 or n < length + 3:
                        break
                    before = t[at[s] - 1 if at[s] > 0 else n - 1]
                    after = t[at[e] + 1 if at[e] + 1 < n else 0]
                    saved = _d(p, last, 2 * before + 1 - f[before], 2 * s + f[s])
                    saved += _d(p, last, 2 * e + 1 - f[e], 2 * after + f[after])
                    saved -= _d(p, last, 2 * before + 1 - f[before], 2 * after + f[after])
                    if saved <= eps:
                        continue
                    for way in range(2):  # by the neighbours of the chain's beginning, then of its end
                        a = 2 * s + f[s] if way == 0 else 2 * e + 1 - f[e]
                        goal = 2 * e + 1 - f[e] if way == 0 else 2 * s + f[s]
                        for k in range(k_most):
                            c = near[a, k]
                            budget -= 1
                            if c < 0:
                                break
                            gain = saved - _d(p, last, a, c)
                            if gain <= eps:
                                break
                            beside = c // 2
                            i = at[beside] - at[s]
                            if i < 0:
                                i += n
                            inside = i < length
                            if inside:
                                continue
                            if c == 2 * beside + 1 - f[beside]:  # behind `beside`, before `other`
                                other = t[at[beside] + 1 if at[beside] + 1 < n else 0]
                                if other == s:
                                    continue
                                gain += _d(p, last, c, 2 * other + f[other]) - _d(p, last, goal, 2 * other + f[other])
                                backwards = way == 1
                                i = at[beside]
                            else:  # before `beside`, behind `other`
                                other = t[at[beside] - 1 if at[beside] > 0 else n - 1]
                                if other == e:
                                    continue
                                gain += _d(p, last, c, 2 * other + 1 - f[other])
                                gain -= _d(p, last, goal, 2 * other + 1 - f[other])
                                backwards = way == 0
                                i = at[other]
                            if gain <= eps:
                                continue
                            steps = _move(t, at, f, n, at[s], length, i, backwards)
                            if steps < 0:
                                continue
                            budget -= steps
                            _push(q, w, n, cython.address(tail), before)
                            _push(q, w, n, cython.address(tail), after)
                            _push(q, w, n, cython.address(tail), beside)
                            _push(q, w, n, cython.address(tail), other)
                            _push(q, w, n, cython.address(tail), e)
                            better = True
                            break
                        if better:
                            break
                    if better:
                        break
    state[0], state[1], state[2] = head, tail, looked
    return budget
