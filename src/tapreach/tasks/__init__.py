"""What the robot does for the operator. The seam towards the server:

- `runner.TaskRunner(context, motion, on_progress)`: `start(task, owner) -> task_id`, `cancel(reason)`,
`progress`,
  `close()`. `motion` is the control loop: the runner admits and dismisses the task there, and stops the
  wheels before it cancels. The context's `report` is set by the runner.
- `locate.LocateTask(tap, target_id)`: shows the target through `context.show_target` as it goes.
- `floor_guess.floor_guess(context, tap, target_id) -> Target`: at once, no motion.
- `guide.Guide(context, runner, kind, owner, target_id, on_change)`: async `start()`, `tap(tap)`,
  `value(name, value)`, `act(name)`, `end()`; `state` is a `GuideState` with the fields of the page's guide
  message. `on_change(state)` is called after every change; `end` stops what the guide had the robot do.
- `compute.ComputeProcess`: `start()`, `close()`; is the context's `compute`. `compute.InlineCompute` for
tests. - Every refusal is a TapreachError whose text is a sentence to show.
"""
