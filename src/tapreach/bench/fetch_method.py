"""What each chapter of the bench of fetching is called, and how it was measured."""

from tapreach.bench.fetch_plan import Chapter

_WHAT = (
    "The whole task as the page starts it, in the rendered simulator in simulated time: a random room of its "
    "own for each run, one tap on any place of the thing at 0.5 to 3 m, from any side and at any bearing in "
    "view; robot and faults drawn anew. Held: by the truth, its foot 20 mm higher than it stood and between "
    "the fingers, at the end and 2 s later. Time: simulated, computing not counted. "
)
_DEFAULT = (
    "Odometry 1 %, slip 2 %, mount off by 1° and 5 mm, servo horns by 2°, a camera 80 ms later than the host "
    "knows, JPEG 80."
)
_HARD = (
    "Odometry 3 %, slip 5 %, mount off by 2° and 10 mm, servo horns by 4°, a camera 150 ms later than the "
    "host knows, 5 % of the frames lost, JPEG 80."
)
_REFUSALS = (
    "Things too wide for the claw, things on a crate or a table higher than the arm, and pictures on a wall, "
    "in turns, in random rooms. Rightly refused: with the true reason, and nothing was moved by 5 mm. "
)
_STOPS = (
    "The operator stops at a moment drawn evenly from 0.3 to 40 s after the tap, looks for 2 s, and lets it "
    "go on; runs that end before that moment have no stop. "
)
_CLUTTER = "Rooms of up to 16 things, and the store room that ships; nothing is told of the others. "

METHOD = {
    Chapter.DEFAULT: _WHAT + _DEFAULT,
    Chapter.HARD: _WHAT + _HARD,
    Chapter.REFUSALS: _REFUSALS + _DEFAULT,
    Chapter.STOPS: _STOPS + _DEFAULT,
    Chapter.CLUTTER: _CLUTTER + _DEFAULT,
}
ARMS_METHOD = (
    "The same rooms, taps and faults; in each arm one part of the whole is left out. No background: the "
    "wheels alone say how the robot turned and drove. No estimating on the way: the place is that of the "
    "first look, carried by the wheels up to the grasp. Fixed move: located from the paper's 12° and 20 cm."
)
TITLE = {
    Chapter.DEFAULT: "One tap to the thing in the claw",
    Chapter.HARD: "The same with hard faults",
    Chapter.REFUSALS: "What cannot be grasped",
    Chapter.STOPS: "Stopped and resumed",
    Chapter.CLUTTER: "In cluttered rooms",
}
