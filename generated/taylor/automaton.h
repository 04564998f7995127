/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 e133df14a0b0711d0bc0ec37c43b1130793527e341e48fdf7463d2b089cb91e8 */

#ifndef AUTOMATON_H
#define AUTOMATON_H

/* What is watched for, in order of precedence among coincident events. */
enum {
    AT_TURNING,
    AT_GLASS,
    AT_CONTACT,
    AT_RUPTURE,
    AT_FILM_EDGE,
    AT_TANGENTIAL_EDGE,
    AT_RELEASE,
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
    KIND_RESTS, /* a rebound too weak to leave is taken for resting contact */
    KIND_RELEASED, /* the normal force on a resting doublet turns outward */
    KIND_RUPTURE, /* the bridge ruptures; without a bridge, the films part */
    KIND_ROTATION_REVERSES, /* the strings turn the rotation back */
    KIND_HALF_TURN, /* the line of centres has turned by pi and the strings cross */
};

/* How a collision ends. */
enum {
    STICK, /* it is proved that the two never separate, or the collision is cut off */
    ROTATE, /* separated, and no rebound criterion was met */
    BOUNCE, /* separated after a rebound criterion was met */
};

/* What is said of a collision; up to PROVED_AT_TOUCH the outcome stands. */
enum {
    DECIDED, /* the outcome is decided */
    PROVED_AT_TOUCH, /* a stick that is proved at initial contact */
    NO_BUDGET, /* the steps are spent */
    NOT_FINITE, /* the state is not finite */
    CHATTER, /* the steps are spent in more than CHATTER_PHASES phases */
    TOO_OBLIQUE, /* the centrifugal force is beyond MOST_OBLIQUE */
};
enum { LAST_ANSWER = PROVED_AT_TOUCH };

/* What a collision is integrated for. */
enum {
    WHOLE, /* to its end */
    APPROACH, /* until it turns or is reversed; without the glass criterion, and nothing is proved */
    ESCAPE, /* until it separates, falls back or rests; proved a stick only while it approaches */
};

static const double REST_SPEED = 1e-09; /* of v0: a slower rebound into an inward force rests */
static const double MOST_OBLIQUE = 1000000000.0; /* of v0^2/x0: a larger centrifugal force turns the motion within rounding of x0 */
static const double LOOSEST = 1e-06; /* relative tolerance: a looser one is tightened to it, or sticks stay unproved */
static const double SAFETY = 30.0; /* a proof holds by more than this many times the tolerance of the largest energy: an error made when the motion was fastest stays in it, and errors of many steps add up */
enum { CHATTER_PHASES = 100 }; /* phases: more are rebound after rebound, and no approach and escape */
enum { FILM_DEPTHS = 16 }; /* steps of equal ratio from the gap to contact, at each of which the film certificate bounds the pressure */
enum { ATTRACTED_FILM_DEPTHS = 48 }; /* the same beside an attraction, which a small gap makes large */
static const double LEAST_DEPTH = 1e-40; /* of the gap: where no contact is met, the film certificate looks no deeper */

#endif
