"""How many threads OpenCV may use in this process."""

import cv2


def use_one_thread() -> None:
    """Keep OpenCV to one thread: on a small machine the others belong to the control loop and the camera."""
    cv2.setNumThreads(1)
