# cython: boundscheck=False, wraparound=False, cdivision=True
"""2-opt and Or-opt on a tour of strokes that may be drawn from either end.

The open path is closed to a tour by one stroke more, number n, which is at distance 0 from everything.
So the ends of the path are as free as all else, and of every reversal the shorter side can be done.
A stroke's ends are the points 2s (its start) and 2s + 1; flips[s] says that it is drawn backwards.

     2-opt    … s │ b … t │ u …      becomes   … s  t … b  u …    (the middle drawn backwards)
     Or-opt   up to three strokes in a row move between two others, either way round.

Candidates come from the nearest neighbours of each end, and a stroke is looked at again only
when one of its links has changed. A count of steps and not a clock ends the search, so that the
bytes are the same on every machine.

What it is worth (`python -m tests.benchmarks.worth tours`): of 20 000 short strokes anywhere the tour is .77 of the way
by the nearest next, of 1000 strokes .79, for .3 s and .01 s of the processor. A plotter needs minutes for such a way.
"""

from libc.math cimport sqrt

cdef int LONGEST = 50000  # strokes: moving a longer stretch would cost more than it brings
cdef int CHAIN = 3  # strokes that Or-opt moves at the most
cdef double LEAST = 1e-7  # points that a step must gain

# What the steps below share; see `improve` for the arrays.
cdef struct Tour:
    const double* points
    const int* near
    int neighbours  # of each end
    int n  # strokes of the tour, with the one that closes it
    int last  # the first end of the stroke that closes the tour
    int* order
    int* place
    unsigned char* flips
    int* queue
    unsigned char* waiting
    int tail  # where the queue's next place is
    long long budget  # steps that are left


cdef inline double _d(Tour* t, int a, int b) noexcept nogil:
    """Distance between two ends; 0 where either belongs to the stroke that closes the tour."""
    cdef double x, y
    if a >= t.last or b >= t.last:
        return 0.0
    x = t.points[2 * a] - t.points[2 * b]
    y = t.points[2 * a + 1] - t.points[2 * b + 1]
    return sqrt(x * x + y * y)


cdef inline int _beside(Tour* t, int s, bint ahead) noexcept nogil:
    """The stroke after s in the tour, if `ahead`, or the one before it."""
    cdef int i = t.place[s]
    if ahead:
        return t.order[i + 1 if i + 1 < t.n else 0]
    return t.order[i - 1 if i > 0 else t.n - 1]


cdef inline int _end(Tour* t, int s, bint ahead) noexcept nogil:
    """The end by which s is linked to the stroke after it, if `ahead`, or to the one before it."""
    return 2 * s + (t.flips[s] ^ ahead)


cdef inline bint _as_good(Tour* t, int c, int wanted) noexcept nogil:
    """Whether candidate c is the end wanted or lies in the same place, as both ends of a dot do."""
    return c == wanted or (t.points[2 * c] == t.points[2 * wanted] and t.points[2 * c + 1] == t.points[2 * wanted + 1])


cdef int _reverse(int* tour, int* place, unsigned char* flips, int n, int i, int j) noexcept nogil:
    """Draw places i … j (around the end, if j < i) backwards, or all others, whichever is less work.

    Returns the steps that it took, -1 where nothing was done because both stretches are too long.
    """
    cdef int k, a, b
    cdef int length = j - i + 1 if j >= i else j - i + 1 + n
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


cdef int _move(
    int* tour, int* place, unsigned char* flips, int n, int i, int length, int to, bint backwards
) noexcept nogil:
    """Move the chain of `length` strokes from place i on to after the stroke at place `to`, which is not one of them.

    Returns the steps that it took, -1 where nothing was done because both ways are too long.
    """
    cdef int[8] chain
    cdef int k, stroke
    # `ahead` strokes lie between the chain and its goal going on, `behind` strokes going back.
    cdef int behind, source
    cdef int ahead = to - (i + length - 1)
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


cdef inline void _push(Tour* t, int s) noexcept nogil:
    """Put s at the end of the queue, if it is not in it."""
    if not t.waiting[s]:
        t.waiting[s] = 1
        t.queue[t.tail] = s
        t.tail = t.tail + 1 if t.tail + 1 < t.n else 0


cdef bint _two_opt(Tour* t, int s, bint ahead) noexcept nogil:
    """Replace the link of s to the stroke after it (`ahead`) or before it, and one more link, if that is shorter."""
    cdef double gain
    cdef int c, i, k, goal, after, steps
    cdef int a = _end(t, s, ahead)
    cdef int other = _beside(t, s, ahead)
    cdef int e = _end(t, other, not ahead)
    cdef double reach = _d(t, a, e)
    for k in range(t.neighbours):
        c = t.near[a * t.neighbours + k]
        t.budget -= 1
        if c < 0:
            break
        gain = reach - _d(t, a, c)
        if gain <= LEAST:
            break
        goal = c // 2
        if not _as_good(t, c, _end(t, goal, ahead)):
            continue
        c = _end(t, goal, ahead)
        after = _beside(t, goal, ahead)
        i = _end(t, after, not ahead)
        gain += _d(t, c, i) - _d(t, e, i)
        if gain <= LEAST:
            continue
        if ahead:
            steps = _reverse(t.order, t.place, t.flips, t.n, t.place[other], t.place[goal])
        else:
            steps = _reverse(t.order, t.place, t.flips, t.n, t.place[s], t.place[after])
        if steps < 0:
            continue
        t.budget -= steps
        _push(t, other)
        _push(t, goal)
        _push(t, after)
        return True
    return False


cdef bint _or_opt(Tour* t, int s, int e, int length) noexcept nogil:
    """Move the chain of `length` strokes from s to e between two others, either way round, if that is shorter."""
    cdef double gain
    cdef int a, c, i, k, goal, other, facing, far, steps, by_end
    cdef bint ahead
    cdef int before = _beside(t, s, False)
    cdef int after = _beside(t, e, True)
    cdef double saved = _d(t, _end(t, before, True), _end(t, s, False))
    saved += _d(t, _end(t, e, True), _end(t, after, False))
    saved -= _d(t, _end(t, before, True), _end(t, after, False))
    if saved <= LEAST:
        return False
    for by_end in range(2):  # by the neighbours of the chain's beginning, then of its end
        a = _end(t, e, True) if by_end else _end(t, s, False)
        far = _end(t, s, False) if by_end else _end(t, e, True)
        for k in range(t.neighbours):
            c = t.near[a * t.neighbours + k]
            t.budget -= 1
            if c < 0:
                break
            gain = saved - _d(t, a, c)
            if gain <= LEAST:
                break
            goal = c // 2
            i = t.place[goal] - t.place[s]
            if i < 0:
                i += t.n
            if i < length:  # a stroke of the chain itself
                continue
            ahead = c == _end(t, goal, True)  # the chain goes after `goal`, else before it
            other = _beside(t, goal, ahead)
            if other == (s if ahead else e):
                continue
            facing = _end(t, other, not ahead)
            gain += _d(t, c, facing) - _d(t, far, facing)
            if gain <= LEAST:
                continue
            i = t.place[goal] if ahead else t.place[other]
            steps = _move(t.order, t.place, t.flips, t.n, t.place[s], length, i, (by_end == 1) == ahead)
            if steps < 0:
                continue
            t.budget -= steps
            _push(t, before)
            _push(t, after)
            _push(t, goal)
            _push(t, other)
            _push(t, e)
            return True
    return False


cdef bint _better(Tour* t, int s) noexcept nogil:
    """Take the first step at stroke s that shortens the tour; False where there is none."""
    cdef int length
    cdef int e = s
    if _two_opt(t, s, True) or _two_opt(t, s, False):
        return True
    for length in range(1, CHAIN + 1):
        if length > 1:
            e = _beside(t, e, True)
        if e == t.n - 1 or t.n < length + 3:
            return False
        if _or_opt(t, s, e, length):
            return True
    return False


def improve(
    const double[:, ::1] points, const int[:, ::1] near, int[::1] tour, int[::1] place, unsigned char[::1] flips,
    int[::1] queue, unsigned char[::1] waiting, long long[::1] state, long long budget, long long stop,
) -> int:
    """Shorten a closed tour in place until nothing helps, or until no more than `stop` of `budget` steps are left.

    Returns the steps left. Called again with the same arrays and that budget it goes on as if it had not stopped.

    points (2n, 2): the strokes' ends. near (2n, k): of each end its nearest ends, nearest first, -1 for none. tour (n +
    1,): strokes in their order, n being the one that closes the tour; place (n + 1,) of each stroke in tour; flips (n +
    1,): 1 for a stroke drawn backwards. queue (n + 1,): strokes to look at, at first in the order of the tour; waiting
    (n + 1,): 1 for each stroke in the queue. state (3,): the queue's head and tail, and how many strokes were looked
    at.
    """
    cdef Tour t
    cdef int s
    cdef int head = <int>state[0]
    cdef long long looked = state[2]
    if tour.shape[0] < 4:
        return budget
    t.points, t.near, t.neighbours = &points[0, 0], &near[0, 0], near.shape[1]
    t.n, t.last = tour.shape[0], 2 * (tour.shape[0] - 1)
    t.order, t.place, t.flips = &tour[0], &place[0], &flips[0]
    t.queue, t.waiting = &queue[0], &waiting[0]
    t.tail = <int>state[1]
    t.budget = budget
    with nogil:
        while t.waiting[t.queue[head]] and t.budget > stop:
            looked += 1
            s = t.queue[head]
            t.waiting[s] = 0
            head = head + 1 if head + 1 < t.n else 0
            if s == t.n - 1:
                continue
            while t.budget > 0 and _better(&t, s):
                pass
    state[0], state[1], state[2] = head, t.tail, looked
    return t.budget
