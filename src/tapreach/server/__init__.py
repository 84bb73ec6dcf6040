"""Row 5: the ASGI app: sockets, sessions, video, access."""
