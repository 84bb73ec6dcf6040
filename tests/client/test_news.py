"""What the client reads is what the server says: held against the server's own messages."""

import pytest
from pydantic import ValidationError

from tapreach.client import news
from tapreach.server import message_parts, messages
from tapreach.server.messages_fetch import NOTHING_FETCHED, FetchView, VerbName

PAIRS = [
    (news.Greeting, messages.Welcome),
    (news.Lens, message_parts.CameraView),
    (news.LeaseNews, message_parts.LeaseView),
    (news.StateNews, messages.State),
    (news.TaskNews, messages.TaskView),
    (news.FetchNews, FetchView),
    (news.TargetNews, messages.TargetView),
]


@pytest.mark.parametrize(("read", "said"), PAIRS)
def test_every_key_that_is_read_is_said_with_the_same_type(read, said):
    for name, field in read.model_fields.items():
        theirs = said.model_fields[name].annotation
        if isinstance(field.annotation, type) and issubclass(field.annotation, news.News):
            assert (field.annotation, theirs) in PAIRS
        elif (read, name) != (news.TargetNews, "source"):
            assert field.annotation == theirs, name


def test_protocol_and_verbs_are_the_server_s():
    assert news.PROTOCOL_VERSION == messages.PROTOCOL_VERSION
    assert news.Verb == VerbName


def test_unknown_keys_are_passed_over_and_missing_ones_are_not():
    said = NOTHING_FETCHED.model_dump(mode="json")
    assert news.FetchNews.model_validate(said | {"mood": "fine"}).phase is None
    del said["stopped"]
    with pytest.raises(ValidationError, match="stopped"):
        news.FetchNews.model_validate(said)
