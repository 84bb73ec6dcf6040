"""An RTSP server of GStreamer, run by the system's Python: /mjpeg and /vp8. Prints its port."""

import sys

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

SOURCE = "videotestsrc is-live=true ! video/x-raw,format=I420,width=320,height=240,framerate=20/1"
CODERS = {
    "/mjpeg": "jpegenc ! rtpjpegpay name=pay0",
    "/vp8": "vp8enc deadline=1 keyframe-max-dist=10 ! rtpvp8pay name=pay0",
}


def main() -> None:
    Gst.init(None)
    server = GstRtspServer.RTSPServer()
    server.set_address("127.0.0.1")
    server.set_service("0")
    for path, coder in CODERS.items():
        factory = GstRtspServer.RTSPMediaFactory()
        factory.set_launch(f"( {SOURCE} ! {coder} )")
        factory.set_shared(True)
        server.get_mount_points().add_factory(path, factory)
    server.attach(None)
    sys.stdout.write(f"{server.get_bound_port()}\n")
    sys.stdout.flush()
    GLib.MainLoop().run()


main()
