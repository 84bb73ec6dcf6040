"""Where a tablet finds the page, and the QR code that takes it there."""

import io
import socket

import segno


def page_address(host: str, port: int, token: str | None) -> str:
    """Return the address to type or scan; it carries the pairing token where one is needed."""
    return f"http://{host}:{port}/" + (f"?token={token}" if token else "")


def address_in_network() -> str:
    """Return this machine's address as others on the network see it; its name when it has none."""
    # Connecting a datagram socket sends nothing: it only asks which interface the kernel would use.
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        try:
            probe.connect(("192.0.2.1", 9))
        except OSError:
            return socket.gethostname()
        address: str = probe.getsockname()[0]
        return address


def qr_code(address: str) -> str:
    """Return the address as a QR code of block characters for the terminal."""
    picture = io.StringIO()
    segno.make(address, error="m").terminal(picture, compact=True)
    return picture.getvalue()
