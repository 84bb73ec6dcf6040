# shellcheck shell=sh
# Servers that the tests of network cameras read from; without them those tests say so.

camera_packages="ustreamer gir1.2-gst-rtsp-server-1.0 python3-gi gstreamer1.0-plugins-good"

want_camera_packages() {
  has ustreamer && /usr/bin/python3 -c 'import gi; gi.require_version("GstRtspServer", "1.0")' 2>/dev/null && return 0
  # shellcheck disable=SC2086  # a list of words
  want_package $camera_packages
}
