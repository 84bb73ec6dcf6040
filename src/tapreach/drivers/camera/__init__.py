"""Cameras of real robots: MJPEG over HTTP, RTSP and V4L2, each read in a thread of its own."""
