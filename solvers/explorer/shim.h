/* What the page calls, behind the text of a law: arrays at fixed places, so that it allocates nothing. */
enum { CELLS = 4096, ROWS = 1200, EVENTS = 64, WIDTH = 18 };
static law_pair_entries pair_entries;
static law_material material;
static law_impact impacts[CELLS];
static law_collision collisions[CELLS];
/* time, gap, normal velocity, rotation, its rate, spins, smallest gap, code; the ledger, NaN where there is none */
static double rows[ROWS][WIDTH];
static double events[EVENTS][3]; /* time, code before, code behind it */
static int event_count;

void *place(int which)
{
    void *places[] = {&pair_entries, &material, impacts, collisions, rows, events};
    return places[which];
}

int size(int which)
{
    const int sizes[] = {sizeof pair_entries, sizeof material, sizeof impacts[0], sizeof collisions[0], ROWS, CELLS};
    return sizes[which];
}

int set_material(void)
{
    return law_material_of(&pair_entries, &material);
}

long many(long count, double rtol, int budget)
{
    return law_collide_many(&material, impacts, count, rtol, budget, collisions);
}

/* What changes at events: motion, whether a stick is certain, whether the film touches, the first rebound criterion. */
static int code_of(const law_contact *c)
{
    return c->motion + 10*(c->outcome == LAW_STICK) + 100*c->wet + 1000*(c->rebound + 1);
}

static int write_row(const law_contact *c, int at)
{
    const double motion[] = {c->time, c->gap,          c->normal_velocity, c->rotation, c->rotation_rate,
                             c->spin, c->partner_spin, c->smallest_gap,    code_of(c)};
#if defined(LAW_LEDGER)
    const double books[] = {c->initial_energy, c->kinetic_energy,  c->normal_loss, c->tangential_loss, c->capillary_work,
                            c->attraction_work, c->dry_loss,       c->strings_work, c->own_loss};
    memcpy(rows[at] + 9, books, sizeof books);
#else
    for (int k = 9; k < WIDTH; k++)
        rows[at][k] = NAN;
#endif
    memcpy(rows[at], motion, sizeof motion);
    return at + 1;
}

/* The first change of code before `ahead`, by bisection on copies; *c is moved behind it. Rows on both sides. */
static int pass_event(law_contact *c, law_contact ahead, int count)
{
    const int before = code_of(c);
    double low = c->time, high = ahead.time;
    for (int k = 0; k < 40 && low + (high - low)/2 > low; k++) {
        law_contact middle = *c;
        law_advance(&middle, low + (high - low)/2);
        if (code_of(&middle) == before) {
            low = middle.time;
            *c = middle;
        } else {
            high = middle.time;
            ahead = middle;
        }
    }
    count = write_row(c, count);
    *c = ahead;
    events[event_count][0] = c->time;
    events[event_count][1] = before;
    events[event_count++][2] = code_of(c);
    return write_row(c, count);
}

/* Rows of one collision (the first impact) at times that grow by a factor: until it ends, or until a stick has been
 * certain for as long as it took to be so, and is still. Returns how many. */
int follow(double rtol, double step, double factor, double still)
{
    law_contact contact, ahead;
    double certain = -1.0;
    event_count = 0;
    if (law_begin(&material, impacts, rtol, 0, &contact) != LAW_OK)
        return 0;
    int count = write_row(&contact, 0);
    for (double goal = step; count < ROWS - 3; goal += step, step *= factor) {
        while (contact.motion < LAW_APART && count < ROWS - 3) {
            ahead = contact;
            if (law_advance(&ahead, goal) != LAW_OK && ahead.motion < LAW_APART)
                return count;
            if (code_of(&ahead) == code_of(&contact) || event_count == EVENTS) {
                contact = ahead;
                break;
            }
            count = pass_event(&contact, ahead, count);
        }
        count = write_row(&contact, count);
        if (contact.motion >= LAW_APART)
            break;
        if (contact.outcome == LAW_STICK && certain < 0.0)
            certain = contact.time;
        if (certain >= 0.0 && goal > 2.0*certain && count > 120 && fabs(contact.normal_velocity) < still)
            break;
    }
    return count;
}

int followed_events(void)
{
    return event_count;
}

const char *message(int status)
{
    return law_message(status);
}
