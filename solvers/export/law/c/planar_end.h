/* What a planar collision says of the end in any direction. */

static ending planar_end(const bodies *b, const arrival *a, const law_collision *found)
{
    ending made = as_arrived(b, a);
    made.status = found->status;
    made.outcome = found->outcome;
    made.certified = found->certified;
    made.time = found->contact_time;
    made.gap = found->final_gap;
    if (found->outcome != LAW_STICK)
        made.opening = a->speed*found->restitution;
    return made;
}

