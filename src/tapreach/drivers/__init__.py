"""Row 3: what moves. One module or folder a robot; chosen by name in the registry."""
