"""Friction and restitution of two surfaces in contact, as of Gazebo's ODE.

ODE takes the smaller coefficient of the two surfaces, Bullet multiplies them. So each surface gets a factor
such that the product of two factors is the smaller of the two coefficients: 1 for static surfaces, and for a
movable one its own coefficient, at most that of most static surfaces. Where this is wrong for some pair that
may meet, because static surfaces differ or movable models touch each other, the factors of friction follow
the present contacts.
"""

from collections import Counter
from itertools import combinations
from typing import Dict, List, Tuple

from sim_bridge.physics.bullet import BulletClient
from sim_bridge.physics.registry import BodyRegistry

# Bullet's limit of the friction of two surfaces.
MAX_FRICTION = 10.0
# Time between two adaptations to the present contacts [simulated s].
PERIOD = 0.02
# Impact speed below which nothing bounces, if no surface has another threshold: Bullet's default [m/s].
BOUNCE_THRESHOLD = 0.2
# Relative difference of a factor that is not set.
TOLERANCE = 1e-9

# Bullet's id of a body, and the index of one of its links.
Part = Tuple[int, int]
Coefficients = Dict[Part, float]


class ContactSurfaces:
    """Sets the coefficients of all surfaces in Bullet.

    Args:
        bullet: The physics engine.
        registry: The surfaces.
    """

    def __init__(self, bullet: BulletClient, registry: BodyRegistry):
        self._bullet, self._registry = bullet, registry
        self._set: Dict[Part, Tuple[float, float]] = {}
        self._friction: Coefficients = {}
        self.reset()

    def reset(self) -> None:
        """Compute all factors again at the next step: bodies were added or removed, or a state restored."""
        self._is_stale, self._is_ambiguous, self._elapsed = True, False, 0.0

    def update(self, seconds: float) -> None:
        """Set the coefficients for the next physics step.

        Args:
            seconds: Duration of the step [simulated s].
        """
        if self._is_stale:
            self._assign()
        if self._is_ambiguous:
            if self._elapsed <= 0.0:
                self._follow_contacts()
                self._elapsed = PERIOD
            self._elapsed -= seconds

    def _assign(self) -> None:
        surfaces = self._registry.surfaces
        self._set = {part: factors for part, factors in self._set.items() if part in surfaces}
        self._friction = {part: min(surface.friction, MAX_FRICTION) for part, surface in surfaces.items()}
        factors = self._factors(self._friction)
        bounce = self._factors({part: surface.restitution for part, surface in surfaces.items()})
        for part in surfaces:
            self._apply(part, factors[part], bounce[part])
        thresholds = [surface.bounce_threshold for surface in surfaces.values() if surface.restitution > 0.0]
        lowest = min([each for each in thresholds if each is not None], default=BOUNCE_THRESHOLD)
        self._bullet.setPhysicsEngineParameter(restitutionVelocityThreshold=lowest)
        self._is_stale, self._is_ambiguous = False, not self._are_exact(factors)

    def _factors(self, coefficients: Coefficients) -> Coefficients:
        """Return the factors that are right if static surfaces agree and movable ones do not touch."""
        static = [value for part, value in coefficients.items() if value > 0.0 and self._is_static(part)]
        usual = Counter(static).most_common(1)[0][0] if static else MAX_FRICTION
        return {
            part: float(value > 0.0) if self._is_static(part) else min(value, usual)
            for part, value in coefficients.items()
        }

    def _are_exact(self, factors: Coefficients) -> bool:
        """Return whether the product of the factors is right for each pair of surfaces that may meet."""
        kinds = Counter(
            {(self._friction[part], factors[part], self._is_static(part), part[0]) for part in factors}
        )
        bodies = Counter(kind[:3] for kind in kinds)
        movable = [kind for kind in bodies if not kind[2] and kind[1] > 0.0]
        static = [kind for kind in bodies if kind[2] and kind[1] > 0.0]
        pairs = [(one, other) for one in movable for other in static]
        pairs += [*combinations(movable, 2), *((kind, kind) for kind in movable if bodies[kind] > 1)]
        return all(_is_equal(one[1] * other[1], min(one[0], other[0])) for one, other in pairs)

    def _follow_contacts(self) -> None:
        """Set the factors of friction so that they are right for the present contacts.

        Starting from static surfaces, the strongest contact of a surface determines its factor. So all
        contacts are right unless they form a cycle.
        """
        factors = self._factors(self._friction)
        known = {part for part in factors if self._is_static(part)}
        pairs = self._contacts()
        while pairs:
            rooted = [pair for pair in pairs if (pair[0] in known) != (pair[1] in known)]
            if not rooted:
                known.add(pairs[0][0])
                pairs = [pair for pair in pairs if not known.issuperset(pair)]
                continue
            one, other = rooted[0] if rooted[0][0] in known else reversed(rooted[0])
            factors[other] = min(self._friction[one], self._friction[other]) / factors[one]
            known.add(other)
            pairs = [pair for pair in pairs if not known.issuperset(pair)]
        for part in factors:
            self._apply(part, factors[part], self._set[part][1])

    def _contacts(self) -> List[Tuple[Part, Part]]:
        """Return the pairs of parts in contact that have friction, the strongest contact first."""
        forces: Counter = Counter()
        for body_id in sorted(self._registry.dynamic_bodies):
            for contact in self._bullet.getContactPoints(bodyA=body_id):
                pair = tuple(sorted(((contact[1], contact[3]), (contact[2], contact[4]))))
                forces[pair] += contact[9]
        return [pair for pair, _ in forces.most_common() if all(self._friction[part] > 0.0 for part in pair)]

    def _apply(self, part: Part, friction: float, restitution: float) -> None:
        before = self._set.get(part)
        if before is None or not _is_equal(friction, before[0]) or not _is_equal(restitution, before[1]):
            self._bullet.changeDynamics(*part, lateralFriction=friction, restitution=restitution)
            self._set[part] = (friction, restitution)

    def _is_static(self, part: Part) -> bool:
        return self._registry.is_static(part[0])


def _is_equal(one: float, other: float) -> bool:
    return abs(one - other) <= TOLERANCE * max(one, other)
