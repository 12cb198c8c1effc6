"""How many threads a process of ours has for linear algebra."""

from threadpoolctl import threadpool_limits


def use_one_blas_thread() -> None:
    """Matrices here are small: more threads of what is imported would only wait for work, in busy loops."""
    threadpool_limits(1, user_api="blas")
