"""A user's field that fails, for module_raises.yaml."""


def field(x):  # noqa: ANN001, ANN201
    return {"x": x.no_such_attribute}
