"""Whether what was sent over a TCP connection of this machine has arrived, by sock_diag(7).

The number of bytes that are not acknowledged does not show it: TCP acknowledges up to 40 ms later.
"""

import socket
import struct

AF_NETLINK, NETLINK_SOCK_DIAG = 16, 4
ANSWER_BYTES, ANSWER_SECONDS = 8192, 0.1
# struct nlmsghdr: length, type, flags, sequence number, port.
HEADER = struct.Struct("=IHHII")
SOCK_DIAG_BY_FAMILY, NLM_F_REQUEST = 20, 1
# struct inet_diag_req_v2: family, protocol, extensions, states, ports, addresses, interface, no cookie.
QUERY = struct.Struct("=BBBxI2s2s16s16sI8s")
WITH_TCP_INFO, ALL_STATES, ANY_COOKIE = 1 << 1, 0xFFFFFFFF, b"\xff" * 8
# struct inet_diag_msg, and struct rtattr after it: length, type.
MESSAGE_BYTES, ATTRIBUTE, TCP_INFO_ATTRIBUTE = 72, struct.Struct("=HH"), 2
# tcpi_bytes_received, tcpi_notsent_bytes, and tcpi_bytes_sent with tcpi_bytes_retrans, in struct tcp_info.
RECEIVED, RECEIVED_OFFSET = struct.Struct("=Q"), 128
UNSENT, UNSENT_OFFSET = struct.Struct("=I"), 144
SENT, SENT_OFFSET, INFO_BYTES = struct.Struct("=QQ"), 200, 216


def has_arrived(end: socket.socket) -> bool:
    """Return whether the other end has received all bytes that were sent; true if the kernel does not know.

    Args:
        end: One end of a connection.
    """
    if end.family not in (socket.AF_INET, socket.AF_INET6):
        return True
    try:
        info = end.getsockopt(socket.IPPROTO_TCP, socket.TCP_INFO, INFO_BYTES)
        other = _other_info(end)
        (unsent,) = UNSENT.unpack_from(info, UNSENT_OFFSET)
        sent, repeated = SENT.unpack_from(info, SENT_OFFSET)
        (received,) = RECEIVED.unpack_from(other, RECEIVED_OFFSET)
    except (OSError, struct.error):
        return True
    return bool(received >= sent - repeated + unsent)


def _other_info(end: socket.socket) -> bytes:
    """Return the struct tcp_info of the other end of a connection; empty if it is not on this machine."""
    (address, port), (own_address, own_port) = end.getpeername()[:2], end.getsockname()[:2]
    ports = (struct.pack("!H", port), struct.pack("!H", own_port))
    addresses = (socket.inet_pton(end.family, each) for each in (address, own_address))
    extensions = (end.family, socket.IPPROTO_TCP, WITH_TCP_INFO, ALL_STATES)
    query = QUERY.pack(*extensions, *ports, *addresses, 0, ANY_COOKIE)
    with socket.socket(AF_NETLINK, socket.SOCK_RAW, NETLINK_SOCK_DIAG) as link:
        link.settimeout(ANSWER_SECONDS)
        link.send(HEADER.pack(HEADER.size + QUERY.size, SOCK_DIAG_BY_FAMILY, NLM_F_REQUEST, 0, 0) + query)
        answer = link.recv(ANSWER_BYTES)
    if HEADER.unpack_from(answer)[1] != SOCK_DIAG_BY_FAMILY:
        return b""
    offset = HEADER.size + MESSAGE_BYTES
    while offset < len(answer):
        length, kind = ATTRIBUTE.unpack_from(answer, offset)
        if kind == TCP_INFO_ATTRIBUTE:
            return answer[offset + ATTRIBUTE.size : offset + length]
        offset += (length + 3) & ~3
    return b""
