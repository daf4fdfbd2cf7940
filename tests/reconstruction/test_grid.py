"""The smallest grid that serves."""

import numpy as np
import pytest
from scipy import ndimage

from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import EdgeList
from penink_cli.reconstruction import enlarge, fit, grid, shrinking
from penink_cli.reconstruction.grid import choose_grid
from penink_cli.reconstruction.reduction import reduce
from tests.reconstruction.scenes import disc, tones


def picture(size=96):
    y, x = (np.mgrid[:size, :size] + 0.5) / size
    return (0.5 + 0.3 * np.sin(9 * x) * np.cos(7 * y)).astype(np.float32)


def test_a_smaller_error_takes_a_finer_grid():
    grey = picture()
    sizes = [choose_grid(grey, EdgeList(96, 96), error / 255).samples.shape[0] for error in (0.05, 0.2)]
    assert 96 > sizes[0] > sizes[1] >= 32


def test_the_error_is_kept_and_reported():
    lines = []
    chosen = choose_grid(picture(), EdgeList(96, 96), 0.1 / 255, report=lines.append)
    assert chosen.error <= 0.1 / 255 and len(lines) > 2


@pytest.mark.parametrize("noise", [0.0, 2 / 255])
def test_the_grid_of_a_large_photo_is_found_in_a_smaller_view_of_it(noise, monkeypatch):
    grey = picture(480) + np.random.default_rng(2).normal(0, noise, (480, 480)).astype(np.float32)
    limit = 2.2 / 255
    slow = choose_grid(picture(480), EdgeList(480, 480), limit, photo=grey)
    monkeypatch.setattr(grid, "VIEW_PX", 20_000)
    seen = []
    plain = grid.remaining_error
    monkeypatch.setattr(grid, "remaining_error", lambda *a: (seen.append(a[2].shape), plain(*a))[1])
    quick = choose_grid(picture(480), EdgeList(480, 480), limit, photo=grey)
    assert seen.count((141, 141)) >= 2 and 1 <= seen.count((480, 480)) <= 3
    assert quick.error <= limit and abs(quick.samples.shape[0] / slow.samples.shape[0] - 1) < 0.12


def test_means_over_parts_that_are_no_whole_pixels():
    rng = np.random.default_rng(3)
    values = rng.random((15, 10)).astype(np.float32)
    found = shrinking.shrunk(values, 2.5)
    halves = np.repeat(np.repeat(values, 2, axis=0), 2, axis=1)  # two a pixel, five a part
    assert np.allclose(found, halves.reshape(6, 5, 4, 5).mean(axis=(1, 3)), atol=1e-6)


def test_every_region_gets_a_sample():
    square = np.array([[40.5, 40.5], [44.8, 40.5], [44.8, 44.8], [40.5, 44.8]])
    edges = EdgeList(96, 96, square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))
    chosen = choose_grid(np.full((96, 96), 0.5, np.float32), edges, 0.1)
    height, width = chosen.samples.shape
    x, y = (np.arange(width) + 0.5) * 96 / width, (np.arange(height) + 0.5) * 96 / height
    inside = ((x > 40.5) & (x < 44.8)).any() and ((y > 40.5) & (y < 44.8)).any()
    assert inside and chosen.empty_regions == 0


@pytest.mark.parametrize(
    ("frame", "side", "regions"), [(64, 3, 1), (64, 4, 2), (1024, 4, 1), (1024, 7, 1), (1024, 9, 2)]
)
def test_a_speck_is_no_region_however_finely_it_is_resolved(frame, side, regions):
    square = np.array([[20, 20], [20 + side, 20], [20 + side, 20 + side], [20, 20 + side]], float)
    edges = EdgeList(frame, frame, square, np.array([[0, 1], [1, 2], [2, 3], [3, 0]]))
    assert len(grid._Regions(edges, frame, frame).known) == regions


@pytest.mark.parametrize("seed", range(3))
def test_the_grid_is_the_least_with_a_sample_in_every_region(seed):
    """Which grids have one is nearly chance: to step by a few percent leaps over many."""
    random = np.random.default_rng(seed)
    low = 24 * np.stack(np.mgrid[:10, :10], -1).reshape(-1, 2) + random.integers(1, 15, (100, 2))
    corners = low[:, None] + np.array([[0, 0], [2, 0], [2, 9], [0, 9.0]])
    ends = np.array([[0, 1], [1, 2], [2, 3], [3, 0]]) + 4 * np.arange(100)[:, None, None]
    edges = EdgeList(240, 240, corners.reshape(-1, 2), ends.reshape(-1, 2))
    grids = [choose_grid(picture(240), edges, error / 255, fit="none") for error in (0.01, 0.4, 2, 4)]
    sides = [grid.samples.shape[0] for grid in grids]
    assert sides == sorted(sides, reverse=True) and sides[0] > sides[-1]

    def every_region_holds_a_sample(side):
        at = (np.arange(side) + 0.5) * 240 / side
        held = (at > low[..., None]) & (at < low[..., None] + [[2], [9]])
        return held.any(axis=2).all()

    assert sides[-1] == next(side for side in range(32, 241) if every_region_holds_a_sample(side))


def test_the_least_side_is_found_in_few_tries_however_the_error_falls():
    random = np.random.default_rng(5)
    tries = []
    for _ in range(400):
        sides = grid._ladder(int(random.integers(1, 60)), int(random.integers(60, 5000)))
        power, knee = random.choice([0.05, 0.3, 0.6, 1.0, 3.0]), random.uniform(1, 6000)
        errors = {side: side**-power * (1 if side < knee else 0.5) for side in sides}
        limit = random.choice([0.0, random.uniform(0, 1.1 * errors[sides[0]])])
        known: dict[int, float] = {}
        found = grid._least_within(limit, sides, errors.__getitem__, known)
        assert found == next((side for side in sides if errors[side] <= limit), sides[-1])
        tries.append(len(known))
    assert np.mean(tries) < 7


def test_what_cannot_be_kept_is_an_error():
    noise = np.random.default_rng(1).random((40, 40)).astype(np.float32)
    with pytest.raises(ParameterError, match="even 40 x 40"):
        choose_grid(np.zeros((40, 40), np.float32), EdgeList(40, 40), 1e-4, photo=noise)


def test_a_grid_may_be_finer_than_the_view_it_is_judged_by(monkeypatch):
    """Where a large photo is so busy that no coarse grid serves."""
    monkeypatch.setattr(grid, "VIEW_PX", 500)
    noise = np.random.default_rng(3).uniform(0, 1, (60, 90)).astype(np.float32)
    edges = EdgeList(90, 60, np.array([[20.0, 20], [60, 40]]), np.array([[0, 1]]))
    with pytest.raises(ParameterError, match=r"0\.50 are allowed \(--max-error\)"):
        choose_grid(noise, edges, 0.5 / 255, photo=np.roll(noise, 7, axis=1))
    chosen = choose_grid(noise, edges, 0.2, photo=noise)
    assert chosen.samples.shape[1] > 30 and chosen.error <= 0.2


def test_a_small_drawing_needs_fewer_samples_and_shows_no_more_than_is_allowed():
    """Fine texture costs samples only where the drawing is large enough to show it."""
    y, x = np.mgrid[0:160, 0:160]
    woven = (0.5 + 0.2 * np.sin(x / 25) + 0.08 * np.sin(x * 1.3) * np.sin(y * 1.3)).astype(np.float32)
    edges = EdgeList(160, 160)
    sides = []
    for inches in (0.5, 2, 20):
        chosen = choose_grid(woven, edges, seen_at=72.0 * inches)
        assert chosen.error <= grid.MAX_SEEN_ERROR
        sides.append(chosen.samples.shape[0])
        sigma = 160 / (72 * inches)
        large = enlarge.reconstruct(chosen.samples.astype(float), edges, 160, 160)
        shown = ndimage.gaussian_filter(large - woven, sigma, mode="nearest")
        assert np.sqrt(np.mean(shown**2)) == pytest.approx(chosen.error, abs=2e-4)
    assert sides[0] == sides[1] < sides[2] / 2


def test_a_smaller_view_tells_of_a_grid_what_the_photo_does():
    """Its pixels blur some of what a width blurs; were it blurred whole again, 2 and 10 % would be missing."""
    tone, edges = disc()
    sharp = tones(tone, 1440).reshape(360, 4, 360, 4).mean(axis=(1, 3))
    texture = ndimage.gaussian_filter(np.random.default_rng(4).normal(size=(360, 360)), 4.0)
    photo = (sharp + 0.03 * texture / texture.std()).astype(np.float32)
    view = grid._View(photo, 0.0, fit.AREA, seen=6.0)
    samples = reduce(photo, edges, 24, 24, photo=photo, fit="lsq", blur=0.0)

    def told(by):
        return grid.remaining_error(samples, edges, by.picture, by.blur, by.fine, seen=by.to_blur())

    for pixels, off in ((14_400, 0.01), (3600, 0.025)):
        assert told(view.smaller(pixels)) == pytest.approx(told(view), rel=off)
        assert grid._detail(view.smaller(pixels)) == pytest.approx(grid._detail(view), rel=0.005)


def test_a_faint_photo_is_allowed_less_error():
    """A third of the contrast takes as fine a grid, or nearly, as the whole: the same error would hide more of it."""
    y, x = np.mgrid[0:192, 0:256]
    strong = (0.5 + 0.2 * np.sin(x / 2.5) * np.cos(y / 3.0)).astype(np.float32)
    faint = ((strong - 0.5) / 3 + 0.5).astype(np.float32)
    edges = EdgeList(256, 192)
    sides = []
    for photo, relative in ((strong, True), (faint, True), (faint, False)):
        chosen = grid.choose_grid(photo, edges, seen_at=300.0, photo=photo, relative=relative)
        sides.append(chosen.samples.shape[1])
    assert sides[2] < sides[1] <= sides[0]
