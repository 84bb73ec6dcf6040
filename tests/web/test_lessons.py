"""Teach-in on the page: who is offered it, what is asked, answered and shown."""

from tests.web.test_layout import with_change, with_jog, with_lessons


def test_menu_offers_lessons_where_the_robot_can_be_taught(server, open_page):
    page = open_page()
    page.click("#menu-open")
    assert page.locator("#menu-lessons").is_hidden()
    page.click("#menu-open")
    with_lessons(page, server)
    assert page.locator("#lesson-acts strong").all_inner_texts() == ["Motors", "Encoders", "Servos"]
    page.click("#lesson-acts button:has-text('Encoders')")
    assert server.wait_for("lesson_start")["lesson"] == "encoders"


def test_answer_names_its_question_and_waits_while_the_robot_moves(server, open_page):
    page = open_page()
    with_jog(page, server)
    steps = page.locator("#lesson-acts button").all_inner_texts()
    assert steps == ["\u221250", "\u221210", "+10", "+50", "It is there"]
    page.click("#lesson-acts button:has-text('+50')")
    answer = server.wait_for("lesson_answer")
    assert (answer["question_id"], answer["answer"]) == (5, "++")
    server.push({"type": "lesson", "lesson": "servos", "said": ["Go by steps."], "question_id": 5})
    page.wait_for_selector("#lesson[aria-busy=true]")
    assert page.locator("#lesson-acts button:disabled").count() == 5
    assert page.inner_text("#lesson-question") == "1450 µs"


def test_change_shows_each_table_once_and_is_written_on_a_yes_alone(server, open_page):
    page = open_page()
    with_change(page, server)
    lines = page.locator("#lesson-change > *").all_inner_texts()
    assert lines[0] == "[arm.servos.shoulder]"
    assert lines[1:3] == ["-low_us = 720", "+low_us = 680"]
    assert lines[3:] == ["-pulse_at_zero_us = 1500", "+pulse_at_zero_us = 1470"]
    assert server.heard("lesson_answer") == []
    page.click("#lesson-acts button:has-text('Yes')")
    assert server.wait_for("lesson_answer")["answer"] == "yes"


def test_watcher_sees_the_lesson_and_cannot_answer(server, open_page):
    page = open_page()
    with_jog(page, server)
    server.change(lease=server.state["lease"] | {"holder_id": 99, "holder_name": "Ben"})
    page.wait_for_selector("#lesson-acts button:disabled")
    assert page.locator("#lesson-acts button:enabled").count() == 0
    assert page.locator("#lesson").is_visible()


def test_end_is_told_in_the_panel_and_closing_it_puts_it_away(server, open_page):
    page = open_page()
    with_jog(page, server)
    page.click("#lesson-close")
    server.wait_for("lesson_end")
    assert page.locator("#lesson").is_visible()
    end = {"ended": "cancelled", "outcome": "stopped by Anna; nothing was written"}
    server.push({"type": "lesson", "lesson": "servos"} | end)
    page.wait_for_selector("#lesson-question:text-is('Stopped by Anna; nothing was written')")
    assert page.locator("#lesson-acts button").all_inner_texts() == ["Again", "All lessons"]
    page.click("#lesson-close")
    assert page.locator("#lesson").is_hidden()
    server.wait_for("lesson_end", 2)
