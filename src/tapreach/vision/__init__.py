"""Row 2: pictures to pixels. Knows no pose."""
