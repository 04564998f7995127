/* The entry points for Python: validation of a task, and the integration of its collisions. */
#pragma once

#include "adjoint.h"
#include "certificates.h"
#include "chain_to_si.h"
#include "driver.h"
#include "layout.h"
#include "limit.h"
#include "model.h"
#include "state.h"
#include "step_record.h"

/* True if a buffer has room for so many rows. */
static int holds(buffer b, int64_t rows, size_t row)
{
    return rows <= b.bytes/(int64_t)row;
}

/* A message naming the buffer of a task that is too small; null if there is none. */
static const char *misfit(const task *t)
{
    if (!holds(t->quantities, QUANTITIES, sizeof(buffer)))
        return "quantities: too small";
    for (int k = 0; k < QUANTITIES; k++) {
        const buffer *column = (const buffer *)t->quantities.at + k;
        if (column->bytes != sizeof(double) && !holds(*column, t->count, sizeof(double)))
            return "a quantity: too small";
    }
    if (!holds(t->answers, t->count, sizeof(answer)))
        return "answers: too small";
#if WITH_LEDGER
    if (!holds(t->books, t->count, sizeof(ledger)))
        return "books: too small";
#endif
#if WITH_TRAJECTORY
    if (t->peaks.bytes && !holds(t->peaks, t->count, sizeof(double)))
        return "peaks: too small";
#endif
#if GRADIENTS
    if (!holds(t->by_group, t->count, GROUPS*RESULTS*sizeof(double)))
        return "by_group: too small";
    if (!holds(t->gradients, t->count, QUANTITIES*RESULTS*sizeof(double)))
        return "gradients: too small";
    if (!holds(t->near, t->count, sizeof(nearness)))
        return "near: too small";
#endif
    return 0;
}

/* Integrates `count` collisions, with derivatives by the quantities if the kernel has them; output buffers must be
 * zeroed. A kernel with a limit follows a single collision, a stick as well, up to `until` unless that is zero.
 *
 * Returns null, or the reason why nothing was done.
 */
const char *collide(task *t)
{
    const char *why = misfit(t);
    if (why || t->count < 1)
        return why;
    queue q;
    memset(&q, 0, sizeof q);
    q.t = t;
    q.columns = (const buffer *)t->quantities.at;
    q.rtol = t->rtol;
    q.answers = (answer *)t->answers.at;
    q.count = t->count;
    q.budget = (int)t->budget;
    q.log = (happening *)t->log.at;
    q.log_room = t->log.bytes/(t->count*(long)sizeof(happening));
#if WITH_LEDGER
    q.books = t->books.at;
#endif
#if WITH_TRAJECTORY
    q.written = t->rows.at;
    q.peaks = t->peaks.bytes ? t->peaks.at : 0;
    q.step_room = t->rows.bytes/(long)sizeof(step_row);
#endif
#if GRADIENTS
    q.requested = (unsigned)t->requested;
    q.by_group = t->by_group.at;
    q.gradients = t->gradients.at;
    q.near = t->near.at;
#endif
#if WITH_LIMIT
    struct interrupted contact;
    memset(&contact, 0, sizeof contact);
    contact.limit = t->until;
    if (t->until > 0.0) {
        q.contact = &contact;
#if WITH_LEDGER
        q.books = &contact.book;
#endif
    }
    run(&q);
    if (q.contact) {
        answer_at_limit(&contact, q.answers);
#if WITH_LEDGER
        *(ledger *)t->books.at = contact.book;
#endif
    }
#elif BACKWARD
    if (!there_and_back(&q))
        return "no memory for its tape";
#else
    run(&q);
#if GRADIENTS
    in_quantities(&q, 0);
#endif
#endif
    return 0;
}
