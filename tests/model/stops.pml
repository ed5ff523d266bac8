/* How a gateway stops its machine, proves that, and remembers it. */

inline keep(g) { /* a re-arm's note comes first, and whether that arms is decided when it is written */
	if
	:: latch[g] == LATCHED && rearm[g] != 2 && (note_armed[g] || writes[g] != 0) -> write_latch(g)
	:: latch[g] != LATCHED && !(note_armed[g] && note_run[g] == holder[g] && writes[g] == 0) -> writes[g] = WRITE_ARMED
	:: else
	fi
}

inline write_latch(g) {
#ifdef LATCH_NOT_WRITTEN
	skip
#else
	writes[g] = WRITE_LATCHED
#endif
}

inline close_latch(g) {
	latch[g] = LATCHED; held_run[g] = 0; held_goal[g] = 0; holder[g] = 0; shown[g] = 1; /* only a re-arm ends it: nobody holds it then */
	if
	:: rearm[g] == 1 -> rearm[g] = 0
#ifndef REARM_NOT_VOID
	:: rearm[g] == 2 -> rearm[g] = 3
#endif
	:: else
	fi
}

inline begin_stop(g, becomes) {
	cancel_flies[machine_of(g)] = 1;
	if
	:: becomes == LATCHED -> close_latch(g); keep(g)
	:: becomes == HELD && current[g] != 0 && latch[g] != LATCHED ->
		latch[g] = HELD; held_run[g] = run_of(current[g]); held_goal[g] = current[g]
	:: else
	fi;
#ifdef HISTORY
	earlier[g] = (stop[g] == KEEPS -> (confirms[g] -> GOOD : BAD) : earlier[g]);
#endif
	stop[g] = PROVES; confirms[g] = 0
}

/* Assumed of time: what left before a stop has arrived, or is lost, when dead time and proof are over. */
#ifdef PROOF_IN_DEAD_TIME
#define proven(g, m) (body[m] != MOVES)
#else
#ifdef GOAL_MAY_BE_OPEN
#define proven(g, m) (!cancel_flies[m] && !host_cancels[m] && body[m] == STANDS)
#else
#define proven(g, m) (!cancel_flies[m] && !host_cancels[m] && body[m] == STANDS && phase[g] != SENT && goal_flies[m] == 0)
#endif
#endif

inline settle(g) { /* without a run, nobody's goal moves it */
	if
	:: confirms[g] && sees_run[g] == 0 -> holder[g] = 0
	:: else
	fi;
	keep(g)
}

inline answer_client(g, how) {
	if
	:: serves[machine_of(g)] == current[g] && current[g] != 0 -> answer[machine_of(g)] = how
	:: else
	fi;
	current[g] = 0; phase[g] = 0; outcome[g] = 0; cancelled[g] = (waiting[g] != 0 && cancelled[g])
}

inline tell_receipt(g) {
	stop[g] = 0; unproven[g] = 0;
	promise(confirms[g] || latch[g] == LATCHED);     /* what was not seen to stand is latched */
	promise(latch[g] != LATCHED || !note_armed[g]);  /* the disk knows a latch before it is told */
	if
	:: current[g] != 0 -> answer_client(g, (latch[g] == HELD -> LOST : BAD))
	:: else
	fi;
	if
	:: asked_stop[g] -> asked_stop[g] = 0; receipt[machine_of(g)] = (confirms[g] -> GOOD : BAD)
	:: else
	fi;
	recovers[g] = recovers[g] && claim_open[g];
	confirms[g] = 0
}
