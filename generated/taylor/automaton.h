/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 74c3db73d2eb50ddc059f841912c1d34d2b981ebebe0f1c5a6d9d8d7681dd77f */

#ifndef AUTOMATON_H
#define AUTOMATON_H
#include <math.h>

/* What is watched for, in order of precedence among coincident events. */
enum {
    AT_TURNING,
    AT_GLASS,
    AT_CONTACT,
    AT_RUPTURE,
    AT_FILM_EDGE,
    AT_TANGENTIAL_EDGE,
    AT_RELEASE,
    AT_SLIPPING,
    AT_ROLLING,
    AT_HALF_TURN,
    AT_UNWINDING,
};

/* What is reported. */
enum {
    KIND_GLASS, /* rebound: the film pressure on the axis reaches the glass-transition pressure */
    KIND_ELASTIC, /* rebound: the gap is down to the elastic length */
    KIND_ROUGH, /* rebound: the gap is down to the roughness */
    KIND_TURNED, /* the normal velocity rises through zero, no rebound criterion met */
    KIND_FELL_BACK, /* the normal velocity falls through zero */
    KIND_FILM_EDGE, /* the gap passes x0 */
    KIND_TANGENTIAL_EDGE, /* the gap passes the reach of the tangential force */
    KIND_RESTS, /* a rebound too weak to open the gap is replaced by resting contact */
    KIND_RELEASED, /* the normal force on a resting doublet turns outward */
    KIND_RUPTURE, /* the bridge ruptures; without a bridge, the films part */
    KIND_ROTATION_REVERSES, /* the strings turn the rotation back */
    KIND_HALF_TURN, /* the line of centres has turned by pi and the strings cross */
    KIND_ROLLS, /* friction holds the surfaces of a resting doublet together: its slip stays zero */
    KIND_SLIDES, /* the surfaces of a resting doublet slide from zero slip: rolling needs more than friction gives */
};

/* How a collision ends. */
enum {
    STICK, /* a certificate excludes separation, or the collision is cut off */
    ROTATE, /* separated, and no rebound criterion was met */
    BOUNCE, /* separated after a rebound criterion was met */
};

/* What is said of a collision; up to PROVED_AT_TOUCH the outcome stands. */
enum {
    DECIDED, /* the outcome is decided */
    PROVED_AT_TOUCH, /* a stick with a certificate at initial contact */
    NO_BUDGET, /* the budget of steps is exhausted */
    NOT_FINITE, /* the state is not finite */
    CHATTER, /* the budget of steps is exhausted after more than CHATTER_PHASES phases */
    TOO_OBLIQUE, /* the centrifugal force is beyond MOST_OBLIQUE */
    ESCAPED, /* a stick that is proved separates when it is followed on: a defect */
    WITHIN_ROUNDING, /* the doublet separates at less than LEAST_PARTING */
    UNDECLARED, /* a declared event creates kinetic energy that it does not declare */
};
enum { LAST_ANSWER = PROVED_AT_TOUCH };

/* What a collision is integrated for. */
enum {
    WHOLE, /* to the end of the collision */
    APPROACH, /* to the first turning point or rebound; without the glass criterion and certificates */
    ESCAPE, /* until the doublet separates, falls back or rests; with certificates only while it approaches */
};

static const double RELEASE_SPEED = 1e-12; /* in v0: with it a resting doublet is released. At rest, where no force is left, rounding would decide in which direction it starts */
static const double MOST_OBLIQUE = 1000000000.0; /* in v0^2/x0: a larger centrifugal force reverses the motion within rounding of x0 */
static const double LOOSEST = 1e-06; /* largest relative tolerance; a larger one is reduced to it, as certificates need it */
static const double SAFETY = 30.0; /* least margin of a certificate in tolerances of the largest energy: errors of the fastest motion persist in the energy, and errors of many steps add up */
static const double STILL = 1e-09; /* in v0: a slower motion is at a turning point */
static const double NO_SLIP = 1e-12; /* in units of the tangential velocity: a smaller slip in resting contact is none */
static const double CREEP = 1e-10; /* the same in space, where friction is less by s/sqrt(s^2 + CREEP^2) at the slip s: rolling surfaces creep */
enum { CHATTER_PHASES = 100 }; /* number of phases beyond which a trajectory is treated as chatter */
enum { CYCLES = 20 }; /* successive maxima of the gap, none above the one before, that count as chatter */
enum { FILM_DEPTHS = 16 }; /* gaps in geometric sequence down to contact at which the film certificate bounds the pressure */
enum { ATTRACTED_FILM_DEPTHS = 48 }; /* the same with an attraction, which grows at small gaps */
enum { APPROACH_PARTS = 24 }; /* parts of the film, in geometric sequence, of the approach certificate */
static const double DEEPEST_PART = 0.01; /* where they end, over x0, unless solid contact is above */
static const double TUMBLES = 0.001; /* in space: a doublet tumbles as one body where all other motion has less than this part of the energy of rigid rotation */
static const double TURNLESS = 3.552713678800501e-15; /* in space: a component that is a smaller part of the largest vector of its kind is rounding, and where all are, nothing rotates */
static const double LEAST_SLIP = 1e-12; /* in the scale of tangential speeds: below it at initial contact no ratio of slips is formed */
static const double LEAST_PARTING = 1.4210854715202004e-14; /* in the scale of tangential speeds times sqrt(x0/a): a slower separation is what rounding of the angular momentum alone sets off, and decides nothing */
static const double LEAST_DEPTH = 1e-40; /* least gap, relative to the present one, of the film certificate without contact */

/* Whether the gap is not below the rupture gap. */
static inline int is_parted(double gap, double rupture_gap)
{
    return gap >= rupture_gap;
}

/* Whether a rebound does not open the gap. */
static inline int is_too_weak(double inward_force, double normal_velocity, double rtol, double gap)
{
    return inward_force > 0 && normal_velocity*normal_velocity/(2*inward_force) < rtol*gap;
}

/* Whether the surfaces do not slip. */
static inline int has_no_slip(double slip)
{
    return fabs(slip) < NO_SLIP;
}

/* Whether friction can hold the surfaces together. */
static inline int friction_holds(double holding, double limit)
{
    return fabs(holding) <= limit;
}

/* Whether rounding of the angular momentum could have opened the doublet. */
static inline int is_within_rounding(double normal_velocity, double obliquity, double aspect)
{
    return normal_velocity < LEAST_PARTING*obliquity*sqrt(aspect);
}

/* Whether the gap is on an edge. */
static inline int is_on_edge(double gap, double edge)
{
    return gap == edge;
}

/* Whether the centrifugal force reverses the motion within rounding. */
static inline int is_too_oblique(double obliquity, double aspect)
{
    return obliquity*obliquity*aspect/16 > MOST_OBLIQUE;
}

#endif
