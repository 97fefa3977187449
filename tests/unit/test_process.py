"""What a process asks of the kernel."""

import socket

import pytest

from common.process.host import limit_silence


def test_tcp_connections_are_given_up_when_nobody_acknowledges() -> None:
    if not hasattr(socket, "TCP_USER_TIMEOUT"):
        pytest.skip("this system has no TCP_USER_TIMEOUT")
    with socket.create_server(("127.0.0.1", 0)) as server, socket.create_connection(server.getsockname()) as client:
        accepted = server.accept()[0]
        one, other = socket.socketpair()
        with accepted, one, other:
            limit_silence(3.0)
            for end in (client, accepted):
                assert end.getsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT) == 3000
            client.sendall(b"still open")
            assert accepted.recv(20) == b"still open"
