"""Old public names resolve to their replacements and warn."""

from dataclasses import dataclass, replace

import pytest

from planar.deprecation import deprecated_names, renamed_fields, renamed_method


def test_an_old_name_resolves_to_its_replacement_with_a_warning():
    resolve = deprecated_names("planar", {"Position": "Pose2"})
    with pytest.warns(DeprecationWarning, match="planar.Position is deprecated; use planar.Pose2"):
        found = resolve("Position")
    assert found.__name__ == "Pose2"


def test_a_replacement_may_be_in_another_module():
    resolve = deprecated_names("planar", {"Position": "planar.geometry.pose:Pose2"})
    with pytest.warns(DeprecationWarning, match="use planar.geometry.pose.Pose2"):
        assert resolve("Position").__name__ == "Pose2"


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'Pose7'"):
        deprecated_names("planar", {})("Pose7")


def test_an_old_method_calls_its_replacement_with_a_warning():
    class Page:
        old = renamed_method("old", "notify")

        def notify(self, text, count=1):
            return text * count

    with pytest.warns(DeprecationWarning, match="Page.old is deprecated; use notify"):
        assert Page().old("a", count=2) == "aa"


@renamed_fields(whole="global_costmap")
@dataclass(frozen=True)
class Context:
    period: float
    global_costmap: str = ""


def test_an_old_field_is_read_with_a_warning():
    context = Context(0.1, "map")
    with pytest.warns(DeprecationWarning, match="Context.whole is deprecated; use global_costmap"):
        assert context.whole == "map"


def test_an_old_field_is_a_keyword_of_the_constructor_and_of_replace():
    with pytest.warns(DeprecationWarning, match="use global_costmap"):
        assert Context(0.1, whole="map") == Context(0.1, "map")
    with pytest.warns(DeprecationWarning, match="use global_costmap"):
        assert replace(Context(0.1, "map"), whole="odom") == Context(0.1, "odom")


def test_new_fields_warn_of_nothing(recwarn):
    assert Context(0.1, global_costmap="map").global_costmap == "map"
    assert not recwarn
