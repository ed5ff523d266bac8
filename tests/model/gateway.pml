/* A gateway: its goals, permits, stops, re-arms and its start. */

#define relay_lost(m, k) (relay[m] != UP || serves[m] != (k)) /* sooner or later seen: nothing tells the moment */
#define run_alive(m) (scheduler == UP && !silent[m] && says[m] != 0)
#ifdef FENCE_NOT_CHECKED
#define run_differs(g, k) (sees_run[g] == 0)
#else
#define run_differs(g, k) (sees_run[g] != run_of(k))
#endif
#define misses(g, m, k) (relay_lost(m, k) || run_differs(g, k))
#define refuses(g, k) (latch[g] == LATCHED || (latch[g] == HELD && (held_run[g] != run_of(k) || held_goal[g] == (k))))
#ifdef SENT_WHILE_HOST_STANDS_IN
#define may_settle(g, m) (stop[g] == 0 && !cancel_flies[m])
#else
#define may_settle(g, m) (stop[g] == 0 && !cancel_flies[m] && !(duty[m] && host == UP))
#endif
#ifdef REARM_WITHOUT_PROOF
#define may_arm(g, m) (current[g] == 0)
#else
#define may_arm(g, m) (stop[g] == 0 && body[m] == STANDS && sick[m] != MUTE && current[g] == 0)
#endif
#ifdef SENT_BEFORE_NOTE
#define noted(g) true
#else
#define noted(g) (writes[g] == 0)
#endif

inline unhold(g, its) { /* an orderly change of the run ends a hold for another run */
	if
	:: latch[g] == HELD && held_run[g] != ANY && held_run[g] != (its) -> latch[g] = ARMED; held_run[g] = 0; held_goal[g] = 0
	:: else
	fi
}

inline hold_for(g, its) {
	if
	:: latch[g] != LATCHED -> latch[g] = HELD; held_run[g] = (its); held_goal[g] = ANY
	:: else
	fi
}

inline claim(g, its) {
	if
	:: claim_open[g] && current[g] == 0 ->
		claim_open[g] = 0;
		if
		:: claim_run[g] != 0 && claim_run[g] != ANY && claim_run[g] != (its) -> begin_stop(g, LATCHED)
		:: claim_run[g] == (its) -> hold_for(g, its)
		:: else -> hold_for(g, its); begin_stop(g, ARMED)
		fi;
		claim_run[g] = 0;
		recovers[g] = recovers[g] && stop[g] != 0
	:: else
	fi
}

inline refuse(g, m) {
	printf("gateway %d refuses goal %d\n", g, waiting[g]);
	if
	:: serves[m] == waiting[g] && g < MACHINES -> answer[m] = BAD
	:: else
	fi;
	waiting[g] = 0; cancelled[g] = 0
}

inline admit(g, m) {
	if
	:: current[g] != 0 || recovers[g] || refuses(g, waiting[g]) -> refuse(g, m)
	:: else ->
		printf("gateway %d admits goal %d\n", g, waiting[g]);
		current[g] = waiting[g]; waiting[g] = 0; phase[g] = NOTING; holder[g] = run_of(current[g]);
		latch[g] = ARMED; held_run[g] = 0; held_goal[g] = 0; away[g] = away[g] && host == UP;
		keep(g)
	fi
}

inline send_goal(g, m) {
	printf("gateway %d sends goal %d of run %d\n", g, current[g], run_of(current[g]));
	promise(!stopped[g]);                                             /* no command after a stop, before a re-arm */
	promise(note_armed[g] && note_run[g] == run_of(current[g]));     /* the disk says whose the motion is */
	promise(run_of(current[g]) == sees_run[g]);                      /* one owner */
	promise(g < MACHINES);                                           /* a second gateway moves nothing */
	promise(!(away[g] && duty[m] && host == UP));                    /* the host agent does not command the machine */
	goal_flies[m] = current[g]; phase[g] = SENT; outcome[g] = 0
}

inline start_gateway(g, m) {
	gateway[g] = UP; claim_open[g] = 1; away[g] = duty[m]; holder[g] = note_run[g];
	if
#ifdef NO_NOTE_MEANS_ARMED
	:: note_armed[g] || g >= MACHINES -> latch[g] = ARMED; shown[g] = 0; claim_run[g] = note_run[g]
#else
	:: note_armed[g] -> latch[g] = ARMED; shown[g] = 0; claim_run[g] = note_run[g]
#endif
	:: else -> latch[g] = LATCHED; shown[g] = 1
	fi;
	promise(!known[g] || latch[g] == LATCHED); /* a latch survives */
#ifndef START_WITHOUT_STOP
	cancel_flies[m] = 1;
	if
	:: latch[g] == LATCHED && unproven[g] -> claim_run[g] = ANY
	:: else
	fi;
	if
	:: claim_run[g] != 0 -> recovers[g] = 1; hold_for(g, claim_run[g]); stop[g] = PROVES
	:: else
	fi
#else
	claim_open[g] = 0; claim_run[g] = 0
#endif
}

inline note_written(g, m) {
	if
	:: writes[g] == WRITE_LATCHED -> note_armed[g] = 0; note_run[g] = 0; unproven[g] = 1; known[g] = 1
	:: else -> note_armed[g] = 1; note_run[g] = holder[g]
	fi;
	writes[g] = 0
}

inline arm(g, m) {
	printf("gateway %d: armed\n", g);
	promise(body[m] == STANDS);
	promise(stopped[g] != 2); /* a press makes a re-arm void that waits for the disk */
	rearm[g] = 0; latch[g] = ARMED; held_run[g] = 0; held_goal[g] = 0; shown[g] = 0;
	stopped[g] = 0; known[g] = 0;
	promise(note_armed[g]) /* armed only if the disk says so */
}

inline hear_press(g) {
	stopped[g] = (rearm[g] >= 2 -> 2 : 1);
	begin_stop(g, LATCHED)
}

proctype Gateway(byte g) {
	byte m = machine_of(g);
end:	do
	/* goals */
	:: atomic { gateway[g] == UP && waiting[g] != 0 && (latch[g] == LATCHED || misses(g, m, waiting[g])) -> refuse(g, m) }
	:: atomic { gateway[g] == UP && waiting[g] != 0 && !misses(g, m, waiting[g]) && may_settle(g, m) && latch[g] != LATCHED -> admit(g, m) }
	:: atomic { gateway[g] == UP && current[g] != 0 && waiting[g] == 0 && cancelled[g] ->
		cancelled[g] = 0;
		if
		:: stop[g] == 0 -> begin_stop(g, ARMED)
		:: else
		fi }
	:: atomic { gateway[g] == UP && phase[g] == NOTING && stop[g] == 0 && noted(g) && !misses(g, m, current[g]) && !cancelled[g] &&
		see(SENDS, g, run_of(current[g])) -> seen; send_goal(g, m) }
	:: atomic { gateway[g] == UP && outcome[g] != 0 ->
		if
		:: stop[g] != 0 -> outcome[g] = 0; phase[g] = 0
		:: else -> answer_client(g, outcome[g])
		fi }
	/* permits */
	:: atomic { gateway[g] == UP && run_alive(m) && sees_run[g] != says[m] ->
		printf("gateway %d sees run %d\n", g, says[m]);
		sees_run[g] = says[m]; unhold(g, says[m]); claim(g, says[m]) }
	:: atomic { gateway[g] == UP && !run_alive(m) && says[m] != 0 && sees_run[g] != 0 ->
		printf("gateway %d has lost the scheduler\n", g);
		sees_run[g] = 0; begin_stop(g, LATCHED) }
	:: atomic { gateway[g] == UP && says[m] == 0 && sees_run[g] != 0 ->
		printf("gateway %d sees that the run has ended\n", g);
		sees_run[g] = 0; unhold(g, 0); holder[g] = 0; keep(g) }
#ifndef LOSS_NOT_SEEN
	:: atomic { gateway[g] == UP && current[g] != 0 && stop[g] == 0 && misses(g, m, current[g]) ->
		printf("gateway %d misses a process behind goal %d\n", g, current[g]);
		begin_stop(g, HELD) }
#endif
	/* stops */
	:: atomic { gateway[g] == UP && signal[g] ->
		printf("gateway %d hears the stop button\n", g);
		signal[g] = 0; hear_press(g) }
	:: atomic { gateway[g] == UP && stop[g] == PROVES && proven(g, m) && sick[m] != MUTE ->
		printf("gateway %d saw its machine stand\n", g);
		promise(body[m] == STANDS && at_server[m] == 0 && goal_flies[m] == 0); /* confirmed means truly standing */
		confirms[g] = 1; stop[g] = KEEPS; settle(g) }
#ifndef NO_TIME_OUT
	:: atomic { gateway[g] == UP && stop[g] == PROVES && sick[m] != 0 && goal_flies[m] == 0 && body[m] != STARTS &&
		(at_server[m] == 0 || sick[m] == DEAF) -> /* its commands were repeated until then */
		printf("gateway %d did not see its machine stand\n", g);
		confirms[g] = 0; stop[g] = KEEPS;
#ifndef NOT_SEEN_NOT_LATCHED
		close_latch(g);
#endif
		settle(g) }
#endif
	:: atomic { gateway[g] == UP && stop[g] == KEEPS && writes[g] == 0 && see((confirms[g] -> CONFIRMED : UNCONFIRMED), g, 0) -> seen;
		printf("gateway %d tells its receipt: confirmed %d\n", g, confirms[g]);
		tell_receipt(g) }
#ifdef HISTORY /* stops that were proven together tell a receipt each */
	:: atomic { gateway[g] == UP && stop[g] == KEEPS && see((confirms[g] -> CONFIRMED : UNCONFIRMED), g, 0) -> seen }
	:: atomic { gateway[g] == UP && earlier[g] != 0 && see((earlier[g] == GOOD -> CONFIRMED : UNCONFIRMED), g, 0) -> seen }
#endif
	:: atomic { gateway[g] == UP && stop[g] == PROVES && at_server[m] != 0 && !cancel_flies[m] && sick[m] != DEAF -> cancel_flies[m] = 1 }
	:: atomic { gateway[g] == UP && writes[g] != 0 && rearm[g] != 2 ->
		note_written(g, m);
		if
		:: rearm[g] == 3 -> rearm[g] = 0; stopped[g] = (stopped[g] != 0); keep(g)
		:: else
		fi }
	/* re-arms, in two steps of a person */
	:: atomic { gateway[g] == UP && arms < ARMS_MOST && latch[g] != ARMED && rearm[g] == 0 && waiting[g] == 0 && may_arm(g, m) &&
		!signal[g] && (g >= MACHINES || !host_press[m] || host != UP) -> count(arms); /* a press arrives, and the host agent looks, sooner than a person can re-arm */
		printf("gateway %d gives out a token to re-arm\n", g);
		rearm[g] = 1 }
	:: atomic { gateway[g] == UP && rearm[g] == 1 && latch[g] != ARMED && may_arm(g, m) -> rearm[g] = 2; holder[g] = 0; writes[g] = WRITE_ARMED }
	:: atomic { gateway[g] == UP && writes[g] != 0 && rearm[g] == 2 && see(ARMS, g, 0) -> seen; note_written(g, m); arm(g, m) }
	/* the start */
	:: atomic { gateway[g] == UP && claim_open[g] && claim_run[g] == 0 && current[g] == 0 && body[m] == MOVES && stop[g] == 0 ->
		printf("gateway %d starts, and its machine moves\n", g);
		claim_run[g] = ANY; recovers[g] = 1; hold_for(g, ANY); begin_stop(g, ARMED) }
	:: atomic { gateway[g] == UP && claim_open[g] && (claim_run[g] != 0 || current[g] != 0 || (body[m] == STANDS && goal_flies[m] == 0)) ->
		claim_open[g] = 0;
		if
		:: claim_run[g] != 0 && latch[g] != LATCHED && current[g] == 0 -> begin_stop(g, LATCHED)
		:: else
		fi;
		claim_run[g] = 0; recovers[g] = recovers[g] && stop[g] != 0 }
	od
}
