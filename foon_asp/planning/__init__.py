"""The planning world: questions as PDDL, plans of planners, and the delete relaxation of planning tasks."""
