"""What a fetch makes use of; all of it, unless somebody measures what one part contributes."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Ways:
    """use_background: what is seen of the background tells how the robot turned and drove; else the wheels
    alone.

    renews_on_way: the thing is followed and estimated on while the robot drives up to it, and located anew
    from near where it is not known well enough; else its place is that of the first look, carried by the
    wheels. fixed_move: it is located from the paper's move instead of from chosen ones.
    """

    use_background: bool = True
    renews_on_way: bool = True
    fixed_move: bool = False
