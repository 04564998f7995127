/* Emitted by wetdoublet from its derivation. Do not edit: change derive/ and run `wetdoublet generate`.
 * Automaton sha256 835c8efa0f6b310100f1672485815d2f3ec0a386a4dd955cbfc1e69cf5f8f5f9
 *
 * What an event does to a lane. Included where `queue`, `lanes`, `fixed` and the functions that it calls, are
 * known. */

static void act(queue *q, lanes *l, fixed *f, int lane, int event)
{
    switch (event) {
    case AT_TURNING:
        note(q, l->index[lane], l->closing[lane] ? KIND_TURNED : KIND_FELL_BACK, l->time[lane]);
        new_phase(l, lane);
        l->y[NORMAL_VELOCITY][lane] = 0.0;
        l->closing[lane] = ~l->closing[lane];
        break;
    case AT_GLASS:
        rebounds(q, l, f, lane, KIND_GLASS);
        break;
    case AT_CONTACT:
        l->y[GAP][lane] = f->contact[lane];
        rebounds(q, l, f, lane, contact_kind(&f->c, lane));
        break;
    case AT_RUPTURE:
        l->y[GAP][lane] = f->end[lane];
        separated(q, l, f, lane);
        break;
    case AT_FILM_EDGE:
        note(q, l->index[lane], KIND_FILM_EDGE, l->time[lane]);
        new_phase(l, lane);
        l->y[GAP][lane] = 1.0;
        l->film[lane] = 1.0 - l->film[lane];
        if (f->edge[lane] == 1.0)
            l->shear[lane] = l->film[lane];
        break;
    case AT_TANGENTIAL_EDGE:
        note(q, l->index[lane], KIND_TANGENTIAL_EDGE, l->time[lane]);
        new_phase(l, lane);
        l->y[GAP][lane] = f->edge[lane];
        l->shear[lane] = 1.0 - l->shear[lane];
        break;
    case AT_RELEASE:
        note(q, l->index[lane], KIND_RELEASED, l->time[lane]);
        new_phase(l, lane);
        l->y[NORMAL_VELOCITY][lane] = RELEASE_SPEED;
        opens(l, f, lane);
        break;
    case AT_SLIPPING:
        note(q, l->index[lane], KIND_ROLLS, l->time[lane]);
        new_phase(l, lane);
        finish(q, l, f, lane, RESTS_IN_FRICTION, STICK, 0);
        break;
    case AT_ROLLING:
        note(q, l->index[lane], KIND_SLIDES, l->time[lane]);
        new_phase(l, lane);
        finish(q, l, f, lane, RESTS_IN_FRICTION, STICK, 0);
        break;
    case AT_HALF_TURN:
        note(q, l->index[lane], KIND_HALF_TURN, l->time[lane]);
        finish(q, l, f, lane, DECIDED, STICK, 0);
        break;
    case AT_UNWINDING:
        note(q, l->index[lane], KIND_ROTATION_REVERSES, l->time[lane]);
        finish(q, l, f, lane, DECIDED, STICK, 0);
        break;
    }
}
