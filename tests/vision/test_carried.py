"""A patch that says nothing in some direction is carried there by its surroundings."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from tapreach.vision.carried import Start, conflict, joined
from tapreach.vision.flow import corners_near, motions_between
from tapreach.vision.look import Fit, fit_look, tapped_look
from tapreach.vision.patch import cut_patch
from tapreach.vision.track import TrackStatus
from tapreach.vision.tracker import PatchTracker
from tapreach.vision.warp import warp_at
from vision.synthetic import photographed, texture, view


def a_fit(own: np.ndarray) -> Fit:
    picture = photographed(view(texture(1))[0], np.random.default_rng(1))
    look = tapped_look(cut_patch(picture, 330.0, 250.0), picture)
    fit = fit_look(look, picture, warp_at(330.0, 250.0))
    assert fit is not None
    return Fit(fit.warp, own, np.zeros((2, 2)), fit.score, fit.support, look, fit.agreement)


FIT = a_fit(np.eye(2))
sigmas = st.floats(0.05, 30.0)


def covariance(across: float, along: float, angle: float) -> np.ndarray:
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[c, -s], [s, c]])
    return axes @ np.diag([across**2, along**2]) @ axes.T


@given(sigmas, sigmas, sigmas, sigmas, st.floats(0.0, 3.1), st.floats(0.0, 3.1))
def test_joined_is_surer_than_neither_by_more_than_the_better(
    a: float, b: float, c: float, d: float, first: float, second: float
) -> None:
    patch, carried = covariance(a, b, first), covariance(c, d, second)
    fit = Fit(FIT.warp, patch, FIT.inherited, FIT.score, FIT.support, FIT.look, FIT.agreement)
    found = joined(fit, Start(FIT.warp, carried)).own
    both = np.linalg.inv(np.linalg.inv(patch) + np.linalg.inv(carried))
    for larger, smaller in ((patch, found), (carried, found), (found, both)):
        assert np.linalg.eigvalsh(larger - smaller).min() > -1e-6 * np.trace(larger)


def test_along_an_edge_the_place_is_where_it_was_carried() -> None:
    across_only = Fit(
        FIT.warp, np.diag([0.1**2, 30.0**2]), FIT.inherited, FIT.score, FIT.support, FIT.look, FIT.agreement
    )
    start = Start(np.add(FIT.warp, [[0.0, 0.0, 2.0], [0.0, 0.0, 5.0]]), np.diag([3.0**2, 0.5**2]))
    found = joined(across_only, start)
    u, v = found.warp[:, 2] - FIT.warp[:, 2]
    assert abs(u) < 0.1 and abs(v - 5.0) < 0.1
    assert found.sigma < 0.5
    assert not conflict(across_only, start)
    assert conflict(across_only, Start(start.warp, np.diag([0.1**2, 0.5**2])))


def test_two_things_that_move_apart_are_two_motions() -> None:
    rng, near, far = np.random.default_rng(3), texture(3), texture(4)
    first, second = view(far)[0], view(far, shift=(1.0, 0.0))[0]
    front, moved = view(near)[0], view(near, shift=(7.0, 0.0))[0]
    first[200:300, 280:340], second[200:300, 287:347] = front[200:300, 280:340], moved[200:300, 287:347]
    before, now = photographed(first, rng), photographed(second, rng)
    motions = motions_between(before, now, corners_near(before, 330.0, 250.0, 50.0), (0.0, 0.0))
    shifts = sorted(float((motion.now_from_before @ [330.0, 250.0, 1.0])[0]) - 330.0 for motion in motions)
    np.testing.assert_allclose(shifts, [1.0, 7.0], atol=0.7)
    assert all(motion.disagreement[0, 0] > 4.0 > motion.disagreement[1, 1] for motion in motions)


def test_place_on_a_straight_edge_keeps_its_place_along_it() -> None:
    rng, surface = np.random.default_rng(5), texture(5)

    def scene(i: int) -> np.ndarray:
        picture = view(surface, shift=(4.0 * i, 3.0 * i))[0]
        u, v = 330 + 4 * i, 250 + 3 * i
        picture[v - 26 : v + 27, u - 26 : u + 27] = 90.0
        picture[v - 26 : v + 27, u : u + 27] = 160.0
        return picture

    tracker = PatchTracker(photographed(scene(0), rng), 330.0, 250.0)
    for i in range(1, 16):
        track = tracker.follow(photographed(scene(i), rng))
        assert track.status is not TrackStatus.LOST, track.reason
        assert track.pixel is not None
        error = np.hypot(track.pixel.u - 330.0 - 4.0 * i, track.pixel.v - 250.0 - 3.0 * i)
        assert error < max(1.0, 3.0 * track.sigma) and error < 4.0
