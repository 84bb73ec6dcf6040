"""Row 6: measures the whole: video, control. Each bench prints tables and writes JSON."""
