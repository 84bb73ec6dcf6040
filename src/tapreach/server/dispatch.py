"""Which method answers which request."""

from collections.abc import Callable
from typing import Any

from tapreach.server import messages as m
from tapreach.server.message_base import Request
from tapreach.server.messages_fetch import Fetch, FetchConfirm, FetchResume, FetchVerb
from tapreach.server.messages_lesson import LessonAnswer, LessonEnd, LessonStart
from tapreach.server.requests_driving import DrivingRequests
from tapreach.server.requests_fetch import FetchRequests
from tapreach.server.requests_lesson import LessonRequests
from tapreach.server.requests_looking import LookingRequests
from tapreach.server.requests_tasks import TaskRequests
from tapreach.server.station import Station
from tapreach.server.visitor import Visitor

Answer = m.Ack | m.Pong | m.Welcome
Answerer = Callable[[Visitor, Any], Any]
"""Takes its own type of request; returns an Answer, or a coroutine of one."""


def answerers(station: Station) -> dict[type[Request], Answerer]:
    """Return the method for every type of request; a test holds it against messages.FromPage.

    A method may raise TapreachError, whose text is then the refusal; those that wait are coroutines.
    """
    driving, looking = DrivingRequests(station), LookingRequests(station)
    tasks, fetching = TaskRequests(station), FetchRequests(station)
    teaching = LessonRequests(station)
    return {
        m.Hello: looking.hello,
        m.Ping: looking.ping,
        m.Capture: looking.capture,
        m.Heartbeat: driving.heartbeat,
        m.Drive: driving.drive,
        m.Stop: driving.stop,
        m.EmergencyStop: driving.emergency_stop,
        m.EmergencyReset: driving.emergency_reset,
        m.ArmStep: driving.arm_step,
        m.ArmGoto: driving.arm_goto,
        m.LeaseRequest: driving.lease_request,
        m.LeaseRelease: driving.lease_release,
        m.LeaseAnswer: driving.lease_answer,
        m.TapTarget: tasks.tap,
        m.TargetClear: tasks.target_clear,
        m.TaskCancel: tasks.task_cancel,
        m.GuideStart: tasks.guide_start,
        m.GuideTap: tasks.guide_tap,
        m.GuideValue: tasks.guide_value,
        m.GuideAct: tasks.guide_act,
        m.GuideEnd: tasks.guide_end,
        Fetch: fetching.fetch,
        FetchConfirm: fetching.confirm,
        FetchResume: fetching.resume,
        FetchVerb: fetching.verb,
        LessonStart: teaching.start,
        LessonAnswer: teaching.answer,
        LessonEnd: teaching.end,
    }
