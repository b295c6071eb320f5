(** * The checker of certificates, and what its acceptance means

    A FOON becomes a problem of plain actions: each unit is one, and so is taking each kitchen item. A rule that asks
    for one of a set of units has a node of its own, which is one more goal, and which each of these units gives. *)

From Coq Require Import ZArith NArith List Lia.
From Coq Require Import FMapPositive.
From Verified Require Import Amount Cuts Foon.
Import ListNotations.
Open Scope bool_scope.

Section Checker.
Variable w : foon.
Variable fs : list objective.
Variable rules : list (id * rule).   (* a rule with a number: that of its node or of its limit *)
Variable denominator : positive.     (* costs are multiplied by it, so that a bound is whole *)
Variable grid : list positive.

(** ** The problem

    Action [u~0] is unit [u], and action [o~1] takes the kitchen item [o]. *)
Definition at_hand o := mem o (kitchen w).
Definition asking u := map fst (filter (fun x => match asks w (snd x) with Some f => f u | None => false end) rules).
Definition given_by (m : id) : list id :=
  match m with
  | xO u => if is_unit w u then filter (fun o => negb (at_hand o)) (made w u) ++ asking u else []
  | xI o => if at_hand o then [o] else []
  | xH => []
  end.
Definition needed_by (m : id) : list id := match m with xO u => needed w u | _ => [] end.
Definition cost_of (m : id) : amount :=
  match m with
  | xO u => if is_unit w u then times (Npos denominator) (unit_cost w fs u) else []
  | xI o => if at_hand o then times (Npos denominator) (item_cost fs) else []
  | xH => []
  end.
Definition numbers {A} (m : PositiveMap.t A) : list id := map fst (PositiveMap.elements m).
Definition all_actions : list id := map xO (numbers (units w)) ++ map xI (numbers (kitchen w)).

(** The actions that give each object, found once. *)
Definition makers_of (o : id) (index : PositiveMap.t (list id)) : list id :=
  match PositiveMap.find o index with Some l => l | None => [] end.
Definition enter (m : id) (index : PositiveMap.t (list id)) : PositiveMap.t (list id) :=
  fold_right (fun o ix => PositiveMap.add o (m :: makers_of o ix) ix) index (given_by m).
Definition index_of (actions : list id) : PositiveMap.t (list id) :=
  fold_right enter (PositiveMap.empty (list id)) actions.

Definition asked_nodes := map fst (filter (fun x => match asks w (snd x) with Some _ => true | None => false end) rules).
Definition row_of (r : rule) : option row :=
  match limit w r with
  | Some (f, n) => Some (Row (fun m => match m with xO u => f u | _ => 0%N end) n)
  | None => None
  end.
Definition find_row (k : id) : option row :=
  match find (fun x => Pos.eqb (fst x) k) rules with Some (_, r) => row_of r | None => None end.

Definition problem_of (index : PositiveMap.t (list id)) : problem :=
  Problem (S (length fs)) needed_by given_by cost_of (fun o => makers_of o index)
          (filter (fun o => negb (at_hand o)) (wanted w) ++ asked_nodes) find_row
          (existsb (fun x => broken_by_goal w (snd x)) rules) grid.

Definition removed : set :=
  of_list (map xO (filter (fun u => existsb (fun x => removes w (snd x) u) rules) (numbers (units w)))).

(** ** The checker *)
Definition goodb p : bool := (0 <=? number p) && (under p <=? over p)%positive.
Fixpoint alignedb (g : list positive) (a : amount) : bool :=
  match g, a with
  | z :: g, p :: a => (number p mod Zpos z =? 0)%Z && alignedb g a
  | _, _ => true
  end.

Definition costs_fit : bool := forallb (fun m => forallb goodb (cost_of m) && alignedb grid (cost_of m)) all_actions.

Definition accept_bound (cuts : PositiveMap.t (list id)) (p : proof) (least : amount) : bool :=
  costs_fit
  && (let P := problem_of (index_of all_actions) in
      check P (PositiveMap.map (cut_of P) cuts) least [] removed p).

Fixpoint executesb (have : set) (us : list id) : bool :=
  match us with
  | [] => true
  | u :: us => is_unit w u && forallb (fun o => at_hand o || mem o have) (needed w u)
               && executesb (fold_right insert have (made w u)) us
  end.
Definition keepsb (us : list id) (r : rule) : bool :=
  negb (broken_by_goal w r)
  && forallb (fun u => negb (removes w r u)) us
  && match asks w r with Some f => existsb f us | None => true end
  && match limit w r with Some (f, n) => (count f us <=? n)%N | None => true end.
Definition same (a b : amount) : bool := match compare (S (length fs)) a b with Eq => true | _ => false end.

Definition accept_tree (us : list id) (costs : amount) : bool :=
  executesb (PositiveMap.empty unit) us
  && forallb (fun o => at_hand o || existsb (fun u => among o (made w u)) us) (wanted w)
  && forallb (fun x => keepsb us (snd x)) rules
  && same (run_cost w fs us) costs.

(** ** Correctness *)

(** By the laws of finite maps. *)
Lemma makers_add o o' l ix : makers_of o (PositiveMap.add o' l ix) = if Pos.eq_dec o o' then l else makers_of o ix.
Proof.
  unfold makers_of. destruct (Pos.eq_dec o o') as [->|H]; [now rewrite PositiveMap.gss|]. now rewrite PositiveMap.gso.
Qed.

(** The action is entered for each object that it gives. *)
Lemma enter_makers m o ix : In o (given_by m) -> In m (makers_of o (enter m ix)).
Proof.
  unfold enter. induction (given_by m) as [|o' l IH]; cbn; [easy|]. intros H. rewrite makers_add.
  destruct (Pos.eq_dec o o') as [->|N]; [now left|]. destruct H as [->|H]; [easy|auto].
Qed.

(** Entries stay when others are added. *)
Lemma enter_keeps m m' o ix : In m' (makers_of o ix) -> In m' (makers_of o (enter m ix)).
Proof.
  intros H. unfold enter. induction (given_by m) as [|o' l IH]; cbn; trivial. rewrite makers_add.
  destruct (Pos.eq_dec o o') as [->|N]; [right|]; trivial.
Qed.

(** Each action is entered once, and stays. *)
Lemma index_makers actions m o : In m actions -> In o (given_by m) -> In m (makers_of o (index_of actions)).
Proof.
  intros Hm Ho. induction actions as [|m' actions IH]; [easy|]. cbn. destruct Hm as [->|Hm].
  - now apply enter_makers.
  - now apply enter_keeps, IH.
Qed.

(** What is found in a map is among its elements. *)
Lemma in_numbers {A} k (m : PositiveMap.t A) x : PositiveMap.find k m = Some x -> In k (numbers m).
Proof. intros H. apply PositiveMap.elements_correct in H. apply in_map_iff. now exists (k, x). Qed.

(** What is not among the actions gives nothing and costs nothing. *)
Lemma action_or_nothing m : In m all_actions \/ (given_by m = [] /\ cost_of m = []).
Proof.
  unfold all_actions. destruct m as [o|u|]; cbn; auto.
  - unfold at_hand, mem. destruct (PositiveMap.find o (kitchen w)) eqn:E; auto.
    left. apply in_or_app. right. apply in_map. eapply in_numbers; eauto.
  - unfold is_unit. destruct (PositiveMap.find u (units w)) eqn:E; auto.
    left. apply in_or_app. left. apply in_map. eapply in_numbers; eauto.
Qed.

(** The index has all actions, and the check of costs looked at all of them. *)
Lemma problem_sound : costs_fit = true -> sound (problem_of (index_of all_actions)).
Proof.
  unfold costs_fit. rewrite forallb_forall. intros H. constructor; cbn.
  - intros m o Ho. apply index_makers; trivial. destruct (action_or_nothing m) as [|[E _]]; trivial.
    now rewrite E in Ho.
  - intros m. destruct (action_or_nothing m) as [A|[_ E]]; [|rewrite E; constructor].
    apply H, andb_prop in A. destruct A as [A _]. rewrite forallb_forall in A. apply Forall_forall.
    intros p Hp. apply A, andb_prop in Hp. destruct Hp as [Hn Hf].
    split; [now apply Z.leb_le|]. now apply Pos.leb_le.
  - intros m. destruct (action_or_nothing m) as [A|[_ E]]; [|rewrite E; now destruct grid].
    apply H, andb_prop in A. destruct A as [_ A]. revert A. generalize (cost_of m). clear.
    induction grid as [|z g IH]; intros [|p a]; cbn; trivial. intros A. apply andb_prop in A. destruct A as [A B].
    split; auto. apply Z.eqb_eq in A. now apply Z.mod_divide.
Qed.

(** *** A task tree is a solution: first take the kitchen items it needs, then execute its units. *)
Definition actions_of (us : list id) : list id := map xI (taken w us) ++ map xO us.

Section Solution.
Variable P : problem.
Hypothesis P_needs : needs P = needed_by.
Hypothesis P_gives : gives P = given_by.

(** Nothing that is there goes away. *)
Lemma ends_have s : forall have, incl have (ends P have s).
Proof.
  induction s as [|m s IH]; cbn; intros have; [apply incl_refl|].
  intros o Ho. apply IH, in_or_app. now right.
Qed.

(** What a run gives is there at its end. *)
Lemma ends_gives m o s : forall have, In m s -> In o (given_by m) -> In o (ends P have s).
Proof.
  induction s as [|m' s IH]; cbn; intros have; [easy|]. intros [->|H] Ho; auto.
  apply ends_have, in_or_app. left. now rewrite P_gives.
Qed.

(** Items can be taken at any time, and are there from then on. *)
Lemma runs_items l s : forall have, (forall o, In o l -> at_hand o = true) ->
  (forall have', incl l have' -> incl have have' -> runs P have' s) -> runs P have (map xI l ++ s).
Proof.
  induction l as [|o l IH]; cbn; intros have Hl Hs; [apply Hs; easy|].
  rewrite P_needs, P_gives. split; [easy|]. cbn. rewrite Hl by now left. apply IH; auto.
  intros have' H1 H2. apply Hs.
  - intros x [<-|Hx]; auto. apply H2. now left.
  - intros x Hx. apply H2. now right.
Qed.

(** What a unit needs is a kitchen item, which was taken, or was made by a unit before it, which gave it. *)
Lemma runs_units us : forall have have',
  executes w have us ->
  (forall o, In o have -> at_hand o = true \/ In o have') ->
  (forall o, In o (flat_map (needed w) us) -> at_hand o = true -> In o have') ->
  runs P have' (map xO us).
Proof.
  induction us as [|u us IH]; cbn; intros have have' He Hh Hk; trivial.
  destruct He as (Hu & Hn & He). rewrite P_needs, P_gives. split.
  - intros o Ho. destruct (at_hand o) eqn:E.
    + apply Hk; trivial. apply in_or_app. now left.
    + destruct (Hn o Ho) as [H|H]; [unfold at_hand in E; congruence|]. destruct (Hh o H) as [|]; [congruence|trivial].
  - cbn. rewrite Hu. apply (IH (made w u ++ have)); trivial.
    + intros o Ho. destruct (at_hand o) eqn:E; [now left|right]. apply in_app_or in Ho. apply in_or_app.
      destruct Ho as [Ho|Ho].
      * left. apply in_or_app. left. apply filter_In. now rewrite E.
      * right. destruct (Hh o Ho) as [|]; [congruence|trivial].
    + intros o Ho E. apply in_or_app. right. apply Hk; trivial. apply in_or_app. now right.
Qed.

(** By the laws of lists. *)
Lemma taken_spec us o : In o (taken w us) <-> In o (flat_map (needed w) us) /\ at_hand o = true.
Proof. unfold taken. rewrite nodup_In, filter_In. reflexivity. Qed.

(** The items are taken first, and then the units find what they need. *)
Lemma runs_tree us : executes w [] us -> runs P [] (actions_of us).
Proof.
  intros H. apply runs_items; [intros o Ho; now apply taken_spec in Ho|].
  intros have' Hi _. apply (runs_units us []); trivial; [easy|].
  intros o Ho E. apply Hi. now apply taken_spec.
Qed.
End Solution.

(** By induction along the run. *)
Lemma executes_units us : forall have u, executes w have us -> In u us -> is_unit w u = true.
Proof. induction us as [|u' us IH]; cbn; intros have u H; [easy|]. destruct H as (Hu & _ & H). intros [<-|Hi]; eauto. Qed.

(** Taking items takes nothing of limits. *)
Lemma count_actions f us : count (fun m => match m with xO u => f u | _ => 0%N end) (actions_of us) = count f us.
Proof.
  unfold actions_of. rewrite count_app. assert (E : forall l, count (fun m => match m with xO u => f u | _ => 0%N end) (map xI l) = 0%N)
    by (induction l; cbn; trivial). rewrite E. cbn. induction us; cbn; congruence.
Qed.

(** It runs; a goal is at hand, or a unit makes it; a node that a rule asks for is given by a unit of the run; and
    limits count the same. *)
Lemma tree_solution us ix :
  task_tree w (map snd rules) us -> solution (problem_of ix) (actions_of us).
Proof.
  intros (He & Hg & Hk). rewrite Forall_map, Forall_forall in Hk. unfold solution. repeat split.
  - now apply runs_tree.
  - intros o Ho. cbn in Ho. apply in_app_or in Ho. destruct Ho as [Ho|Ho].
    + apply filter_In in Ho. destruct Ho as [Ho N]. apply Bool.negb_true_iff in N.
      destruct (Hg o Ho) as [H|(u & Hu & Hm)]; [unfold at_hand in N; congruence|].
      apply (ends_gives (problem_of ix) eq_refl (xO u)).
      * apply in_or_app. right. now apply in_map.
      * cbn. rewrite (executes_units us [] u He Hu). apply in_or_app. left. apply filter_In. now rewrite N.
    + apply in_map_iff in Ho. destruct Ho as ((k & r) & Hk' & Hr). cbn in Hk'. subst k. apply filter_In in Hr. destruct Hr as [Hr Ha].
      cbn in Ha. destruct (asks w r) as [f|] eqn:E; try discriminate.
      destruct (Hk _ Hr) as (_ & _ & Has & _). destruct (Has f E) as (u & Hu & Hf).
      apply (ends_gives (problem_of ix) eq_refl (xO u)).
      * apply in_or_app. right. now apply in_map.
      * cbn. rewrite (executes_units us [] u He Hu). apply in_or_app. right. apply in_map_iff. exists (o, r). split; trivial.
        apply filter_In. split; trivial. cbn. now rewrite E.
  - cbn. apply Bool.not_true_iff_false. rewrite existsb_exists. intros (x & Hx & Hb).
    destruct (Hk _ Hx) as (Hn & _). congruence.
  - cbn. unfold find_row. intros k r Hf. destruct (find _ rules) as [[k' r']|] eqn:E; try discriminate.
    apply find_some in E. destruct E as [E _]. unfold row_of in Hf.
    destruct (limit w r') as [[f n]|] eqn:El; try discriminate. injection Hf as <-. cbn.
    rewrite count_actions. destruct (Hk _ E) as (_ & _ & _ & Hl). now apply Hl.
Qed.

(** A run that keeps to the rules has no unit that a rule removes. *)
Lemma tree_fits us : task_tree w (map snd rules) us -> fits [] removed (actions_of us).
Proof.
  intros (He & _ & Hk). rewrite Forall_map, Forall_forall in Hk. split; [easy|]. intros m Hm.
  destruct (mem m removed) eqn:E; trivial. exfalso. apply mem_of_list, in_map_iff in E. destruct E as (u & <- & Hu).
  apply filter_In in Hu. destruct Hu as [_ Hu]. apply existsb_exists in Hu. destruct Hu as (x & Hx & Hr).
  destruct (Hk _ Hx) as (_ & Hn & _). rewrite Hn in Hr; [discriminate|].
  apply in_app_or in Hm. destruct Hm as [Hm|Hm]; apply in_map_iff in Hm; destruct Hm as (y & Ey & Hy); congruence.
Qed.

(** Units and items cost in the problem what they cost in the FOON. *)
Lemma tree_cost us ix : executes w [] us ->
  total (cost (problem_of ix)) (actions_of us) = times (Npos denominator) (run_cost w fs us).
Proof.
  intros He. unfold actions_of, run_cost. rewrite total_app, times_plus, plus_comm, <- !total_times. f_equal.
  - assert (H : forall u, In u us -> is_unit w u = true) by (intros u; now apply executes_units with (have := [])).
    clear He. induction us as [|u us IH]; cbn [map total]; trivial. rewrite IH by auto with datatypes. f_equal.
    cbn. now rewrite H by now left.
  - assert (H : forall o, In o (taken w us) -> at_hand o = true) by (intros o Ho; now apply taken_spec in Ho).
    induction (taken w us) as [|o l IH]; cbn [map total]; trivial. rewrite IH by auto with datatypes. f_equal.
    cbn. now rewrite H by now left.
Qed.

(** ** The theorems *)

(** An accepted bound: each task tree, multiplied by the denominator, costs at least as much. *)
Theorem accepted_bound cuts p least :
  accept_bound cuts p least = true ->
  forall us, task_tree w (map snd rules) us ->
  le (S (length fs)) least (times (Npos denominator) (run_cost w fs us)).
Proof.
  intros H us Ht. apply andb_prop in H. destruct H as [Hc H].
  rewrite <- (tree_cost us (index_of all_actions)) by apply Ht.
  eapply (check_ok (problem_of (index_of all_actions))); eauto using problem_sound, tree_solution, tree_fits, NoDup_nil.
  set (P := problem_of (index_of all_actions)). intros k c Hf.
  destruct (PositiveMap.map_2 cuts (cut_of P) (ex_intro _ c Hf : PositiveMap.In k _)) as (l & E). exists l.
  apply (PositiveMap.map_1 (cut_of P)) in E. unfold PositiveMap.MapsTo in E. congruence.
Qed.

(** The set that the checker keeps has what the run has made. *)
Lemma executesb_ok us : forall have l, (forall o, mem o have = true <-> In o l) -> executesb have us = true -> executes w l us.
Proof.
  induction us as [|u us IH]; cbn; intros have l Hl H; trivial.
  apply andb_prop in H. destruct H as [H He]. apply andb_prop in H. destruct H as [Hu Hn]. repeat split; trivial.
  - intros o Ho. rewrite forallb_forall in Hn. apply Hn, Bool.orb_true_iff in Ho. destruct Ho as [Ho|Ho]; [now left|right]. now apply Hl.
  - apply (IH (fold_right insert have (made w u))); trivial. intros o. rewrite in_app_iff, <- Hl.
    clear. induction (made w u) as [|x m IH]; cbn; [tauto|]. rewrite mem_insert, IH. intuition congruence.
Qed.

(** An accepted tree executes, makes the goals, keeps to the rules, and costs what is said. *)
Theorem accepted_tree us costs :
  accept_tree us costs = true ->
  task_tree w (map snd rules) us /\ compare (S (length fs)) (run_cost w fs us) costs = Eq.
Proof.
  unfold accept_tree. intros H. apply andb_prop in H. destruct H as [H Hc]. apply andb_prop in H. destruct H as [H Hk].
  apply andb_prop in H. destruct H as [He Hg]. unfold same in Hc. split; [|now destruct (compare _ _ costs)].
  repeat split.
  - apply (executesb_ok us (PositiveMap.empty unit) []); trivial. intros o. unfold mem. rewrite PositiveMap.gempty. split; [discriminate|easy].
  - intros o Ho. rewrite forallb_forall in Hg. apply Hg, Bool.orb_true_iff in Ho. destruct Ho as [Ho|Ho]; [now left|right].
    apply existsb_exists in Ho. destruct Ho as (u & Hu & Ho). apply among_in in Ho. eauto.
  - rewrite Forall_map, Forall_forall. rewrite forallb_forall in Hk. intros x Hx. apply Hk in Hx.
    apply andb_prop in Hx. destruct Hx as [Hx Hl]. apply andb_prop in Hx. destruct Hx as [Hx Ha].
    apply andb_prop in Hx. destruct Hx as [Hb Hr]. repeat split.
    + now apply Bool.negb_true_iff.
    + intros u Hu. rewrite forallb_forall in Hr. now apply Bool.negb_true_iff, Hr.
    + intros f E. rewrite E in Ha. now apply existsb_exists.
    + intros f n E. rewrite E in Hl. now apply N.leb_le.
Qed.
End Checker.

(** A tree and a proof of what it costs, both accepted: no task tree costs less. *)
Definition accept_optimal w fs rules grid cuts p us costs : bool :=
  accept_tree w fs rules us costs && accept_bound w fs rules 1 grid cuts p costs.

Theorem accepted_optimal w fs rules grid cuts p us costs :
  accept_optimal w fs rules grid cuts p us costs = true ->
  task_tree w (map snd rules) us
  /\ compare (S (length fs)) (run_cost w fs us) costs = Eq
  /\ forall others, task_tree w (map snd rules) others -> le (S (length fs)) (run_cost w fs us) (run_cost w fs others).
Proof.
  intros H. apply andb_prop in H. destruct H as [Ht Hb]. apply accepted_tree in Ht. destruct Ht as [Ht Hc].
  split; [|split]; trivial. intros others Ho. apply le_trans with costs; [unfold le; rewrite Hc; discriminate|].
  apply (times_cancel _ 1); [reflexivity|]. eapply le_trans; [|eapply accepted_bound; eauto].
  rewrite times_1. apply le_refl.
Qed.

(** Without objectives all costs are 0. Who proves that each tree costs at least 1 proves that there is none. *)
Definition accept_infeasible w rules cuts p : bool := accept_bound w [] rules 1 [] cuts p [sum_of 1].

Theorem accepted_infeasible w rules cuts p :
  accept_infeasible w rules cuts p = true -> forall us, ~ task_tree w (map snd rules) us.
Proof.
  intros H us Ht. pose proof (accepted_bound _ _ _ _ _ _ _ _ H us Ht) as L. unfold run_cost in L.
  assert (E : forall l, total (unit_cost w []) l = []) by (induction l; cbn; trivial).
  assert (F : forall l : list id, total (fun _ => item_cost []) l = []) by (induction l; cbn; trivial).
  rewrite E, F in L. now apply L.
Qed.

Check accepted_bound.
Print Assumptions accepted_bound.
Check accepted_tree.
Print Assumptions accepted_tree.
Check accepted_optimal.
Print Assumptions accepted_optimal.
Check accepted_infeasible.
Print Assumptions accepted_infeasible.
