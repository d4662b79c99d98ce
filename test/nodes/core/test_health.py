"""What is reported, when, and with which text."""

from pierburg_ros.nodes.core.health import ERROR, OK, REPORT_PERIOD, SHORTEST_REPORT, WARN, Condition, Health

TASKS = {"": "running", "sensor": "well"}


def reports(health, seconds, change):
    """Number of reports within so many seconds, `change` being called a thousand times a second."""
    count = 0
    for step in range(round(seconds * 1000)):
        change(step)
        if health.is_due(step * 0.001):
            health.report(TASKS, step * 0.001)
            count += 1
    return count


def test_without_news_it_reports_once_a_second():
    assert reports(Health(), 10.0, lambda step: None) in (10, 11)


def test_a_condition_that_flickers_is_told_ten_times_a_second_at_most():
    health = Health()

    def flicker(step):
        if step % 2:
            health.begin("spike", Condition("sensor", WARN, "a spike"))
        else:
            health.end("spike")

    assert reports(health, 5.0, flicker) <= 5.0 / SHORTEST_REPORT + 1


def test_a_condition_over_before_the_report_is_still_told_once():
    health = Health()
    health.begin("spike", Condition("sensor", WARN, "a spike"))
    health.end("spike")
    assert [(each.level, each.message) for each in health.report(TASKS, 0.0)][1] == (WARN, "a spike (over)")
    assert [(each.level, each.message) for each in health.report(TASKS, REPORT_PERIOD)][1] == (OK, "well")


def test_the_newest_text_is_told_and_the_worst_level_counts():
    health = Health()
    assert health.begin("range", Condition("sensor", WARN, "duty 7"))
    assert not health.begin("range", Condition("sensor", WARN, "duty 9"))
    health.begin("finite", Condition("sensor", ERROR, "duty nan"))
    status = health.report(TASKS, 0.0)[1]
    assert status.level == ERROR
    assert status.message == "duty 9; duty nan"


def test_each_task_has_its_own_status():
    health = Health()
    health.begin("range", Condition("sensor", WARN, "too far"))
    assert [each.level for each in health.report(TASKS, 0.0)] == [OK, WARN]


def test_a_refusal_is_told_by_the_node_itself_for_a_while():
    health = Health()
    health.refuse("setpoint 9", 0.0)
    assert [health.report(TASKS, now)[0].level for now in (0.0, 9.0, 11.0)] == [WARN, WARN, OK]
