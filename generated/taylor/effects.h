/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 74c3db73d2eb50ddc059f841912c1d34d2b981ebebe0f1c5a6d9d8d7681dd77f
 *
 * What an event does to a lane. Included where `queue`, `lanes`, `fixed` and the functions that it calls, are
 * known. */

static void act(queue *q, lanes *l, fixed *f, int lane, int event)
{
    switch (event) {
    case AT_TURNING:
        note(q, LANE(l->index, lane), LANE(l->closing, lane) ? KIND_TURNED : KIND_FELL_BACK, LANE(l->time, lane));
        new_phase(l, lane);
        LANE(l->y[NORMAL_VELOCITY], lane) = 0.0;
        LANE(l->closing, lane) = LANE(l->closing, lane) ? 0 : TRUTH;
        break;
    case AT_GLASS:
        rebounds(q, l, f, lane, KIND_GLASS);
        break;
    case AT_CONTACT:
        LANE(l->y[GAP], lane) = LANE(f->contact, lane);
        rebounds(q, l, f, lane, contact_kind(&f->c, lane));
        break;
    case AT_RUPTURE:
        LANE(l->y[GAP], lane) = LANE(f->end, lane);
        parts(q, l, f, lane);
        break;
    case AT_FILM_EDGE:
        note(q, LANE(l->index, lane), KIND_FILM_EDGE, LANE(l->time, lane));
        new_phase(l, lane);
        LANE(l->y[GAP], lane) = 1.0;
        LANE(l->film, lane) = 1.0 - LANE(l->film, lane);
        if (LANE(f->edge, lane) == 1.0)
            LANE(l->shear, lane) = LANE(l->film, lane);
        break;
    case AT_TANGENTIAL_EDGE:
        note(q, LANE(l->index, lane), KIND_TANGENTIAL_EDGE, LANE(l->time, lane));
        new_phase(l, lane);
        LANE(l->y[GAP], lane) = LANE(f->edge, lane);
        LANE(l->shear, lane) = 1.0 - LANE(l->shear, lane);
        break;
    case AT_RELEASE:
        note(q, LANE(l->index, lane), KIND_RELEASED, LANE(l->time, lane));
        new_phase(l, lane);
        LANE(l->y[NORMAL_VELOCITY], lane) = RELEASE_SPEED;
        opens(l, f, lane);
        break;
    #if ROLLS
    case AT_SLIPPING:
        note(q, LANE(l->index, lane), grips(l, f, lane), LANE(l->time, lane));
        new_phase(l, lane);
        break;
    #endif
    #if ROLLS
    case AT_ROLLING:
        note(q, LANE(l->index, lane), KIND_SLIDES, LANE(l->time, lane));
        new_phase(l, lane);
        slides(l, f, lane);
        break;
    #endif
    case AT_HALF_TURN:
        note(q, LANE(l->index, lane), KIND_HALF_TURN, LANE(l->time, lane));
        finish(q, l, f, lane, DECIDED, STICK, 0);
        break;
    case AT_UNWINDING:
        note(q, LANE(l->index, lane), KIND_ROTATION_REVERSES, LANE(l->time, lane));
        finish(q, l, f, lane, DECIDED, STICK, 0);
        break;
    }
}
