"""Who may open the page."""

import pytest

from common.security import web_access as access


@pytest.mark.parametrize("host", ["127.0.0.1", "127.3.2.1", "::1", "[::1]", "localhost", "ip6-localhost"])
def test_loopback_needs_no_token(host: str) -> None:
    assert access.is_loopback(host)
    assert access.token_for(host, "") == ""


@pytest.mark.parametrize(
    "host", ["0.0.0.0", "::", "192.168.1.5", "robot.local", "", "localhost.evil.com", "X127.0.0.1"]
)
def test_any_other_address_gets_a_token_that_nobody_can_guess(host: str) -> None:
    assert not access.is_loopback(host)
    first, second = access.token_for(host, ""), access.token_for(host, "")
    assert len(first) == 32, "24 bytes, 192 bits, in base 64"
    assert first != second


def test_a_token_that_could_be_guessed_is_refused() -> None:
    with pytest.raises(ValueError, match="at least 16"):
        access.token_for("0.0.0.0", "12345")
    with pytest.raises(ValueError, match=r"^dashboard\.token: 15 characters; at least 16 are needed$"):
        access.token_for("127.0.0.1", "x" * 15)
    assert access.token_for("127.0.0.1", "x" * 16) == access.token_for("0.0.0.0", "x" * 16) == "x" * 16


def test_only_the_token_opens_the_door() -> None:
    token = "0123456789abcdef"
    assert access.admits("", None)
    assert access.admits(token, None, token)
    assert not access.admits(token, None, "")
    assert not access.admits(token, "0123456789abcdeF", token[:-1])


def test_another_sites_name_that_leads_here_is_refused() -> None:
    assert access.host_is_ours("127.0.0.1:8080", "")
    assert access.host_is_ours("localhost:8080", "")
    assert access.host_is_ours("[::1]:8080", "")
    assert not access.host_is_ours("evil.example:8080", "")
    assert access.host_is_ours("robot.example:8080", "some token that is long")


def test_another_sites_page_may_not_connect() -> None:
    assert access.same_origin(None, "127.0.0.1:8080")
    assert access.same_origin("http://127.0.0.1:8080", "127.0.0.1:8080")
    assert not access.same_origin("http://evil.example", "127.0.0.1:8080")
    assert not access.same_origin("http://127.0.0.1:9999", "127.0.0.1:8080")
    assert not access.same_origin("null", "127.0.0.1:8080")
    assert access.same_origin("https://127.0.0.1:8080", "127.0.0.1:8080"), "behind a proxy that adds TLS"
