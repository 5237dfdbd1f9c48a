"""A claim of tests in Python: what is wrong is an error, in words."""


def raises(kind, words, call):
    """The call raises an error of this kind whose message has these words."""
    try:
        call()
    except kind as error:
        assert words in str(error), error
        return
    raise AssertionError(f"no {kind.__name__}: {words}")
