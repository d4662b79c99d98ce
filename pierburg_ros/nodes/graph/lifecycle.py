"""A managed node (lifecycle_msgs) that is active by default and survives transitions that do not exist."""

from __future__ import annotations

from lifecycle_msgs.srv import ChangeState
from rclpy.lifecycle import LifecycleNodeMixin, LifecycleState, TransitionCallbackReturn

from pierburg_ros.nodes.graph.parameters import LiveNode

DONE = TransitionCallbackReturn.SUCCESS


class ManagedNode(LifecycleNodeMixin, LiveNode):
    """Adds the transitions to a live node; a subclass says what `activate` and `deactivate` do."""

    def __init__(self, name: str) -> None:
        LiveNode.__init__(self, name)
        LifecycleNodeMixin.__init__(self)
        self.is_active = False
        self._change_state = self._service_change_state.callback
        self._service_change_state.callback = self._on_change_state

    def activate(self) -> None:
        """Begin the work."""

    def deactivate(self) -> None:
        """End the work and leave a safe state."""

    def begin(self) -> None:
        """Become active, unless `autostart` is false."""
        if self.values["autostart"]:
            self.trigger_configure()
            self.trigger_activate()

    def destroy_node(self) -> None:
        """Leave the graph, which the state machine otherwise keeps the node on."""
        super().destroy_node()
        self._state_machine.destroy_when_not_in_use()

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The transition to active."""
        self.is_active = True
        self.activate()
        return DONE

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The transition to inactive."""
        self._stand_down()
        return DONE

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """The transition to the end of the process."""
        self._stand_down()
        self.stopping.set()
        return DONE

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """After a transition that failed: back to unconfigured, without work."""
        self._stand_down()
        self.diagnostics.refuse("a transition failed; the node is unconfigured")
        return DONE

    def _stand_down(self) -> None:
        if self.is_active:
            self.is_active = False
            self.deactivate()

    def _on_change_state(self, request: ChangeState.Request, response: ChangeState.Response) -> ChangeState.Response:
        """`rclpy` raises out of the executor where a transition does not start from the present state."""
        possible = {each[0] for each in self._state_machine.available_transitions}
        possible_labels = {each[1] for each in self._state_machine.available_transitions}
        wanted = request.transition
        if wanted.label not in possible_labels if wanted.label else wanted.id not in possible:
            self.diagnostics.refuse(
                f"transition {wanted.label or wanted.id} does not start from {self._state_machine.current_state[1]}; "
                f"possible are {', '.join(sorted(possible_labels))}."
            )
            response.success = False
            return response
        return self._change_state(request, response)
