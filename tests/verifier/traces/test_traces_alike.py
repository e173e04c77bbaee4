"""What names of columns and fields are taken to mean."""

import pytest

from verifier.traces.alike import alike, is_asked, meaning

ODOM = [f"/odom.pose.pose.{end}" for end in ("orientation.w", "orientation.x", "position.x")]


@pytest.mark.parametrize(
    "names",
    [
        ("heading", "theta", "yaw_rad", "/odom.pose.pose.orientation.@yaw"),
        ("turn", "omega", "yaw_rate", "turn_cmd", "/cmd_vel.angular.z", "/imu.angular_velocity.z"),
        ("speed", "v", "vx_cmd", "/cmd_vel.linear.x", "/odom.twist.twist.linear.x"),
        ("x", "/odom.pose.pose.position.x", "/goal.position.x", "/mocap.x"),
    ],
)
def test_names_of_one_quantity_mean_the_same(names: tuple[str, ...]) -> None:
    assert len({meaning(name) for name in names}) == 1


def test_a_quaternion_has_no_position_and_no_turn_rate() -> None:
    assert alike("x", ODOM) == ODOM[2]
    assert alike("turn", ODOM) == ""
    assert alike("x", ["/imu.linear_acceleration.x"]) == ""


def test_what_is_told_is_put_to_what_is_told() -> None:
    assert (
        alike("v_cmd", ["/odom.twist.twist.linear.x", "/cmd_vel.linear.x"]) == "/cmd_vel.linear.x"
    )
    assert alike("v", ["v_cmd", "v"]) == "v"


@pytest.mark.parametrize("name", ["/cmd_vel.linear.x", "v_cmd", "setpoint", "headingGoal", "set_v"])
def test_commands_are_known_by_their_names(name: str) -> None:
    assert is_asked(name)


@pytest.mark.parametrize("name", ["offset", "reset", "/odom.x", "settled", "asset"])
def test_other_words_are_no_commands(name: str) -> None:
    assert not is_asked(name)
