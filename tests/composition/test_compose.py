"""Composition: what it must leave alone, what it must do to tones and colours, one result for all threads."""

from __future__ import annotations

import io
from functools import partial

import numpy as np
import pytest
import skimage.color
import skimage.data
from scipy.ndimage import gaussian_filter

from penink_cli.composition import exposure, filters, mixing, recolouring
from penink_cli.composition._compiled import tones
from penink_cli.composition.compose import Choice, compose, compose_colours, narrow_range, working_size
from penink_cli.formats import pgm, photo
from penink_cli.ground.errors import ParameterError
from penink_cli.ground.model import ColourImage, GreyImage
from tests.oracles import tones as oracle

RNG = np.random.default_rng(5)


def composed(values: np.ndarray, width_pt: float = 432.0, *, mask: np.ndarray | None = None, **choice: object):
    image = ColourImage(values) if values.ndim == 3 else GreyImage(values)
    threads, oval = choice.pop("threads", 1), choice.pop("oval", False)
    where = None if mask is None else GreyImage(mask)
    return compose(image, Choice(width_pt, **choice), photo.grey_of, where, threads=threads, oval=oval)


def step(low: float, high: float, pixels_per_pt: int) -> np.ndarray:
    """A step in the middle of a page of 200 × 100 pt, with a black and a white corner that keep the points."""
    grey = np.full((100 * pixels_per_pt, 200 * pixels_per_pt), low)
    grey[:, 100 * pixels_per_pt :] = high
    corner = 10 * pixels_per_pt
    grey[:corner, :corner], grey[:corner, -corner:] = 0, 1
    return np.round(grey * 255).astype(np.uint8)


@pytest.mark.parametrize("pixels_per_pt", [1, 2, 4])
@pytest.mark.parametrize(("low", "high"), [(0.35, 0.65), (0.2, 0.5), (0.5, 0.8)])
def test_a_step_has_no_halo(low, high, pixels_per_pt):
    grey = composed(step(low, high, pixels_per_pt), 200.0)
    rows = grey[60 * pixels_per_pt : 80 * pixels_per_pt].mean(axis=0)
    middle = 100 * pixels_per_pt
    for side in (rows[:middle][::-1], rows[middle:]):
        far = np.median(side[40 * pixels_per_pt : 60 * pixels_per_pt])
        assert np.abs(side[2 * pixels_per_pt : 40 * pixels_per_pt] - far).max() <= 0.02
    assert rows[middle + 3 * pixels_per_pt] - rows[middle - 3 * pixels_per_pt] > 0.3  # and is a step still


def in_colours(values: np.ndarray, mask: np.ndarray | None = None, threads: int = 1, **choice: object) -> np.ndarray:
    image = ColourImage(values) if values.ndim == 3 else GreyImage(values)
    return compose_colours(image, Choice(432.0, **choice), None if mask is None else GreyImage(mask), threads=threads)


@pytest.mark.parametrize("name", ["astronaut", "coffee", "chelsea"])
def test_colours_are_as_light_as_the_grey_and_keep_their_hue(name):
    values = getattr(skimage.data, name)()[::2, ::2, :3]
    found, grey = in_colours(values), composed(values, mix=recolouring.LUMA)
    lab, own = skimage.color.rgb2lab(found), skimage.color.rgb2lab(values)
    assert np.abs(lab[..., 0] - skimage.color.rgb2lab(np.dstack([grey] * 3))[..., 0]).max() < 0.5
    chroma, before = np.hypot(lab[..., 1], lab[..., 2]), np.hypot(own[..., 1], own[..., 2])
    seen = (chroma > 4) & (before > 4)
    assert seen.mean() > 0.2
    turn = np.arctan2(lab[..., 2], lab[..., 1]) - np.arctan2(own[..., 2], own[..., 1])
    assert np.abs((turn[seen] + np.pi) % (2 * np.pi) - np.pi).max() < 0.1
    growth = np.sqrt(np.maximum(lab[..., 0], 1) / np.maximum(own[..., 0], 1))
    assert (chroma <= before * growth + 1).all()
    full = (found > 0.02).all(axis=-1) & (found < 0.98).all(axis=-1)  # all of it where such a colour exists
    assert np.abs(chroma - before * growth)[full].max() < 0.7


def test_colours_at_strength_0_are_the_photos_and_outside_a_mask_white():
    values = skimage.data.astronaut()[::4, ::4]
    assert np.array_equal(ColourImage.from_colours(in_colours(values, strength=0.0)).values, values)
    mask = np.zeros(values.shape[:2], np.uint8)
    mask[:, :60] = 255
    found = in_colours(values, mask)
    assert (found[:, 60:] == 1).all()
    assert found[:, :60].min() < 0.1


def test_a_grey_photos_colours_are_grey_and_any_threads_do():
    grey = skimage.data.camera()[::3, ::3]
    found = in_colours(grey)
    assert np.abs(found[..., 0] - found[..., 2]).max() < 0.005
    assert np.abs(found[..., 1] - composed(grey)).max() < 0.01
    colours = skimage.data.coffee()[::2, ::2]
    assert np.array_equal(in_colours(colours), in_colours(colours, threads=3))


@pytest.mark.parametrize("name", ["astronaut", "camera", "rocket"])
def test_strength_0_is_the_luma_as_stored(name):
    values = getattr(skimage.data, name)()
    stored = photo.grey_of(ColourImage(values)).values if values.ndim == 3 else values
    assert np.array_equal(GreyImage.from_grey(composed(values, strength=0.0)).values, stored)


def test_a_little_strength_changes_little():
    values = skimage.data.astronaut()
    stored = composed(values, strength=0.0)
    assert np.abs(composed(values, strength=0.01) - stored).max() < 0.05
    assert np.abs(composed(values, strength=0.3) - composed(values, strength=0.2999)).max() < 0.01


@pytest.mark.parametrize("name", ["astronaut", "camera", "chelsea", "coffee", "coins", "rocket"])
def test_paper_and_black_are_spent(name):
    values = getattr(skimage.data, name)()
    before, after = composed(values, strength=0.0), composed(values)
    assert (after > 0.95).mean() > max(0.02, (before > 0.95).mean())
    assert (after < 0.05).mean() > 0.03
    smooth = [gaussian_filter(g, 2)[8:-8, 8:-8].ravel() for g in (before, after)]
    assert np.corrcoef(*smooth)[0, 1] > 0.7


def test_more_strength_and_a_higher_key_are_lighter():
    values = skimage.data.chelsea()
    means = [
        float(composed(values, strength=s, target=exposure.TARGETS[t]).mean())
        for s, t in ((0.9, "high-key"), (0.9, "house"), (0.3, "house"))
    ]
    assert means == sorted(means, reverse=True) and means[0] > means[1] + 0.1


def test_any_threads_give_the_same_bytes():
    values = skimage.data.rocket()
    one = composed(values, 300.0, pixels_per_pt=1.7)
    for threads in (2, 5):
        assert np.array_equal(one, composed(values, 300.0, pixels_per_pt=1.7, threads=threads))


def test_a_page_keeps_its_paper():
    page = np.full((300, 400), 252, np.uint8)
    page[RNG.random(page.shape) < 0.5] = 255
    page[100:104, 40:360], page[200:240, 100:140] = 20, 120
    grey = composed(page)
    assert (grey[page > 250] > 0.985).mean() > 0.95 and grey[101:103, 50:350].max() < 0.1


def test_outside_the_mask_paper_stays_white():
    values = skimage.data.camera()
    mask = np.zeros(values.shape, np.uint8)
    mask[100:400, 50:300] = 255
    hard, soft = composed(values, mask=mask), composed(values, mask=mask, fade_pt=20.0)
    for grey in (hard, soft):
        assert (grey[mask == 0] == 1).all()
    inside = np.zeros(values.shape, bool)
    inside[150:350, 100:250] = True
    assert np.abs(soft - hard)[inside].max() < 0.1
    border = (slice(200, 300), slice(51, 54))
    assert soft[border].mean() > hard[border].mean() + 0.3
    with pytest.raises(ParameterError, match="the mask has 511 x 512 pixels; the photo has 512 x 512"):
        composed(values, mask=mask[:, 1:])


def test_an_oval_fades_the_corners_out():
    grey = composed(np.full((200, 300), 40, np.uint8), oval=True, fade_pt=30.0)
    assert (grey[:20, :20] == 1).all() and grey[100, 150] < 0.7


def test_a_scan_s_rim_is_left_out():
    inner = skimage.data.chelsea()
    framed = inner.copy()
    framed[:5], framed[-3:], framed[:, :6] = 0, 250, 10
    grey, plain = composed(framed), composed(inner)
    assert np.abs(grey[:4].mean() - plain[:8].mean()) < 0.15 and grey[:, :5].mean() > 0.2
    assert mixing.without_rim(inner, 255) is inner


def test_colours_of_one_luma_are_told_apart():
    picture = np.zeros((120, 120, 3), np.uint8)
    squares = (np.indices((120, 120)) // 30).sum(axis=0) % 2 == 0
    picture[squares], picture[~squares] = (200, 60, 40), (0, 160, 60)
    assert np.ptp(photo.grey_of(ColourImage(picture)).values) <= 4
    mix = mixing.chosen_mix(filters.shrunk(picture, 120, 120, 1 / 255), 1.0)
    assert abs(sum(mix) - 1) < 1e-9
    grey = mixing.mixed(filters.shrunk(picture, 120, 120, 1 / 255), mix)
    assert abs(float(grey[squares].mean() - grey[~squares].mean())) > 0.15


def test_a_grey_photo_in_colours_is_mixed_by_luma():
    grey = np.repeat(skimage.data.camera()[..., None], 3, axis=2)
    assert np.abs(composed(grey) - composed(skimage.data.camera())).max() < 0.01


def test_a_large_photo_is_worked_on_as_the_drawing_shows_it():
    small = skimage.data.coffee()
    large = np.kron(small, np.ones((3, 3, 1), np.uint8))
    assert working_size(large.shape, 150.0) == (600, 400)
    assert np.abs(composed(large, 150.0) - composed(small, 150.0)).max() < 0.02


@pytest.mark.parametrize("shape", [(1, 1), (1, 9), (9, 1), (2, 3), (17, 400), (40, 30, 3), (1, 1, 3)])
@pytest.mark.parametrize("fill", [0, 128, 255, None])
def test_small_and_empty_pictures(shape, fill):
    values = RNG.integers(0, 256, shape, np.uint8) if fill is None else np.full(shape, fill, np.uint8)
    for width in (20.0, 432.0, 5000.0):
        grey = composed(values, width, oval=True, fade_pt=5.0)
        assert np.isfinite(grey).all() and grey.min() >= 0 and grey.max() <= 1


def test_a_flat_photo_is_not_torn_apart():
    values = RNG.integers(126, 130, (200, 200)).astype(np.uint8)
    assert composed(values).std() < 0.06
    assert narrow_range(GreyImage(values)) < 0.02 and narrow_range(GreyImage(skimage.data.camera())) is None


@pytest.mark.parametrize("sigma", [0.4, 1.0, 3.5, 4.8, 9.0, 40.0])
def test_blur_is_gaussian(sigma):
    values = gaussian_filter(RNG.random((150, 230)), 2).astype(np.float32)
    expected = gaussian_filter(values.astype(float), sigma, mode="reflect", truncate=3.0)
    assert np.abs(filters.blurred(values, sigma) - expected).max() < 0.08 * values.std() + 1e-6


PIXELS = {  # what composing does to each pixel: of how many pictures, and with which numbers
    "stretched": (1, {"low": 0.13, "by": 1.7}), "based": (3, {}), "stirred": (2, {"noise": 0.02}), "rooted": (1, {}),
    "weighed": (1, {"by": 2.3}), "lifted_by": (3, {"key": 0.9}), "without_shine": (2, {}),
    "blanked": (2, {"light": 0.68, "more": 0.4, "paper": 0.95}), "sunk": (2, {}), "less_light": (3, {}),
    "gained": (6, {"gain": 1.8}), "guarded": (2, {"level": 0.1, "twice": 0.2}), "drawn": (3, {}), "with_room": (3, {}),
}  # fmt: skip


@pytest.mark.parametrize("name", PIXELS)
def test_kernels_do_to_pixels_what_numpy_does_one_operation_after_the_other(name):
    count, numbers = PIXELS[name]
    rng = np.random.default_rng(7)
    pictures = [(rng.random((40, 53)) * 1.3 - 0.2).astype(np.float32) for _ in range(count)]
    pictures[-1][::2] *= np.float32(0.05)  # where the curves bend
    expected = getattr(oracle, name)(*pictures, **numbers)
    work = partial(getattr(tones, name), **numbers)
    try:
        for width in (16, 32):
            tones.take_lanes(width)
            assert (filters.by_pixels(work, *pictures, threads=2) == expected).all()
    finally:
        tones.take_lanes(32)


@pytest.mark.parametrize("depth", [np.uint8, np.uint16, np.float32])
@pytest.mark.parametrize("channels", [1, 2, 3, 4])
def test_vectors_of_any_width_filter_and_shrink_the_same(depth, channels):
    """Sums of one place's parts in their order, told in a plain loop; and of whole numbers as if they were divided."""
    rng = np.random.default_rng(4)
    values = (rng.random((23, 75, channels)) * 200).astype(depth)
    whole = 200 if depth != np.float32 else 1
    picture = np.divide(values, whole, dtype=np.float32)
    weights = filters.gaussian(1.7)
    found = []
    try:
        for width in sorted({filters.filters.take_lanes(bytes_) for bytes_ in (16, 32)}):
            filters.filters.take_lanes(width)
            plain = filters.shrunk(picture, 31, 7)
            assert (filters.shrunk(values, 31, 7, whole=whole) == plain).all()
            across = np.empty(picture.shape[:2], np.float32)
            filters.filters.across(picture[..., 0].copy(), weights, across, 0, 23)
            found.append((plain.tobytes(), filters.shrunk(values, 31, 7).tobytes(), across.tobytes()))
    finally:
        filters.filters.take_lanes(32)
    assert len(set(found)) == 1
    wide = np.pad(picture[..., 0], ((0, 0), (9, 9)), mode="symmetric")
    slow = weights[0] * wide[:, 9:-9]
    for k in range(1, len(weights)):
        slow += weights[k] * (wide[:, 9 - k : -9 - k] + wide[:, 9 + k : wide.shape[1] - 9 + k])
    assert (slow == across).all()


def test_shrinking_takes_means_of_areas():
    values = RNG.integers(0, 65536, (60, 90, 3), np.uint16)
    means = values.reshape(20, 3, 30, 3, 3).mean(axis=(1, 3))
    assert np.abs(filters.shrunk(values, 30, 20) - means).max() < 0.1
    assert abs(float(filters.shrunk(values, 41, 17).mean()) - values.mean()) < 1


def test_lab_is_that_of_the_library():
    colours = RNG.random((30, 40, 3)).astype(np.float32)
    assert np.abs(mixing.lab(colours) - skimage.color.rgb2lab(colours)).max() < 0.02


def test_composed_greys_are_photos_to_the_other_filters(penink, tmp_path):
    (tmp_path / "p.pgm").write_bytes(pgm.header(60, 40, 255) + RNG.integers(0, 256, 2400, np.uint8).tobytes())
    done = penink("compose", "--width", "2in", "--verbose", tmp_path / "p.pgm")
    assert done.returncode == 0 and b"black point" in done.stderr
    grey = pgm.read(io.BytesIO(done.stdout), "g.pgm", 10**6)
    assert grey.values.shape == (40, 60)
    target = "0:0,.09:.07,.20:.34,.38:.68,.57:.92,.64:.99,1:1"
    arguments = ("--width", "2in", "--threads", "3", "--target", target)
    again = penink("compose", *arguments, input=(tmp_path / "p.pgm").read_bytes())
    assert again.stdout == done.stdout
    assert penink("detect-edges", input=done.stdout).returncode == 0
    deep = penink("compose", "--width", "2in", "--maxval", "65535", tmp_path / "p.pgm")
    assert np.abs(pgm.read(io.BytesIO(deep.stdout), "g", 10**6).grey - grey.grey).max() < 0.6 / 255


@pytest.mark.parametrize(
    ("option", "value", "complaint"),
    [
        ("--mix", "1,2", "is neither auto nor weights that sum to 1"),
        ("--mix", "0.5,0.5,0.5", "is neither auto nor weights that sum to 1"),
        ("--target", "dark", "is none of house, high-key, spot, nor SHARE:GREY"),
        ("--target", "0:0,0.5:2,1:1", "nor SHARE:GREY"),
        ("--target", "0:0,0.5:0.5", "a target begins at 0:0 and ends at 1:1"),
        ("--target", "0:0,0.6:0.5,0.5:0.7,1:1", "shares must rise"),
        ("--strength", "1.5", "is not a number from 0 to 1"),
        ("--dpi", "0", "is not a number from 1"),
    ],
)
def test_wrong_options_are_told(option, value, complaint, penink):
    done = penink("compose", "--width", "2in", option, value, input=b"P5 1 1 255\n0")
    assert done.returncode == 2 and complaint in done.stderr.decode() and done.stderr.count(b"\n") == 1


def test_a_photo_of_a_fraction_of_the_range_is_warned_of(penink):
    photo = pgm.header(60, 40, 255) + RNG.integers(100, 130, 2400, np.uint8).tobytes()
    done = penink("compose", "--width", "2in", input=photo)
    assert done.returncode == 0 and b"the photo uses 11% of the range of grey" in done.stderr
    assert done.stderr.count(b"\n") == 1
