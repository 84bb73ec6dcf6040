"""Row 3: a script's side of the sockets. `connect` is asynchronous; `client.sync.connect` blocks."""

from tapreach.client.control_link import RequestRefused
from tapreach.client.fetching import Fetching, FetchResult, FetchStatus
from tapreach.client.news import FetchNews, TargetNews
from tapreach.client.remote_robot import RemoteRobot, connect
from tapreach.client.snapshot import Snapshot
from tapreach.client.task_watch import TaskResult

__all__ = [
    "FetchNews",
    "FetchResult",
    "FetchStatus",
    "Fetching",
    "RemoteRobot",
    "RequestRefused",
    "Snapshot",
    "TargetNews",
    "TaskResult",
    "connect",
]
