(** * Why weighted cuts are a proof

    The argument, on plain numbers: actions need and give objects, at first there are none, and a solution is a
    sequence of actions that each find what they need and that give every goal. [Checker.v] makes actions of the
    units of a FOON and of taking kitchen items. *)

From Coq Require Import ZArith NArith List Lia Permutation.
From Coq Require Import FMapPositive.
From Verified Require Import Amount.
Import ListNotations.
Open Scope bool_scope.

Notation id := positive.

(** ** Sets of numbers *)

Definition set := PositiveMap.t unit.
Definition mem (x : id) (s : set) : bool := match PositiveMap.find x s with Some _ => true | None => false end.
Definition insert (x : id) (s : set) : set := PositiveMap.add x tt s.
Definition of_list (l : list id) : set := fold_right insert (PositiveMap.empty unit) l.
Definition among (x : id) (l : list id) : bool := existsb (Pos.eqb x) l.

(** By the laws of finite maps. *)
Lemma mem_insert x y s : mem x (insert y s) = true <-> x = y \/ mem x s = true.
Proof.
  unfold mem, insert. destruct (Pos.eq_dec x y) as [->|H].
  - rewrite PositiveMap.gss. tauto.
  - rewrite PositiveMap.gso by trivial. tauto.
Qed.

(** By induction along the list. *)
Lemma mem_of_list x l : mem x (of_list l) = true <-> In x l.
Proof.
  induction l as [|y l IH]; cbn.
  - unfold mem. rewrite PositiveMap.gempty. intuition discriminate.
  - rewrite mem_insert, IH. intuition congruence.
Qed.

(** By the meaning of [existsb]. *)
Lemma among_in x l : among x l = true <-> In x l.
Proof.
  unfold among. rewrite existsb_exists. split.
  - intros (y & H & E). apply Pos.eqb_eq in E. now subst.
  - intros H. exists x. split; trivial. apply Pos.eqb_refl.
Qed.

(** ** Counting *)

Fixpoint count (f : id -> N) (l : list id) : N := match l with [] => 0 | x :: l => f x + count f l end%N.

(** By induction along the list. *)
Lemma count_app f l m : count f (l ++ m) = (count f l + count f m)%N.
Proof. induction l as [|x l IH]; cbn; lia. Qed.

(** ** What is proved, and the proofs *)

(** A limit: how much each action takes of it, and how much there is. *)
Record row := Row { takes : id -> N; most : N }.

(** A set of objects, with actions that give one of them and need none. *)
Record cut := Cut { holds : set; members : list id }.

(** Weights of cuts and of limits by their numbers, all [scale] times as large as they are meant, so that they are
    whole; and the objectives for which the sum is rounded up. *)
Record leaf := Leaf { scale : N; weights : list (id * amount); limits : list (id * amount); rounded : list bool }.

Inductive proof :=
| Weighed (l : leaf)
| Fixed (l : leaf) (above : list id) (others : proof)
| Hopeless (cut : id)
| Broken
| Branch (action : id) (left_out used : proof).

Record problem := Problem {
  objectives : nat;
  needs : id -> list id;
  gives : id -> list id;
  cost : id -> amount;
  makers : id -> list id;      (* of each object *)
  goals : list id;
  rows : id -> option row;
  impossible : bool;           (* a rule leaves no solution *)
  grid : list positive         (* what costs are multiples of, by objective *)
}.

(** A part of a cost is no number below 0 and no factor below 1. *)
Definition good_part p := 0 <= number p /\ (under p <= over p)%positive.

Fixpoint aligned (g : list positive) (a : amount) : Prop :=
  match g, a with
  | z :: g, p :: a => (Zpos z | number p) /\ aligned g a
  | _, _ => True
  end.

Record sound (P : problem) : Prop := {
  makers_all : forall m o, In o (gives P m) -> In m (makers P o);
  cost_good : forall m, Forall good_part (cost P m);
  cost_aligned : forall m, aligned (grid P) (cost P m)
}.

Section Solutions.
Variable P : problem.

Fixpoint runs (have s : list id) : Prop :=
  match s with
  | [] => True
  | m :: s => incl (needs P m) have /\ runs (gives P m ++ have) s
  end.
Fixpoint ends (have s : list id) : list id :=
  match s with [] => have | m :: s => ends (gives P m ++ have) s end.

Definition solution (s : list id) : Prop :=
  runs [] s /\ incl (goals P) (ends [] s) /\ impossible P = false
  /\ forall k r, rows P k = Some r -> (count (takes r) s <= most r)%N.

(** ** The checker *)

Definition avoids (c : set) (l : list id) : bool := forallb (fun o => negb (mem o c)) l.

Definition cut_of (l : list id) : cut :=
  let c := of_list l in
  let found := filter (fun m => avoids c (needs P m)) (flat_map (makers P) l) in
  Cut c (map fst (PositiveMap.elements (of_list found))).

Variable cuts : PositiveMap.t cut.
Variable least : amount.
Let n := objectives P.

(** With [used] actions, each solution reaches something in the cut: a goal, or what a used action needs. *)
Definition required (used : list id) (c : cut) : bool :=
  existsb (fun o => mem o (holds c)) (goals P)
  || existsb (fun u => existsb (fun o => mem o (holds c)) (needs P u)) used.

Definition load_of (m : id) (loads : PositiveMap.t amount) : amount :=
  match PositiveMap.find m loads with Some a => a | None => [] end.
Definition pour (w : amount) (ms : list id) (loads : PositiveMap.t amount) : PositiveMap.t amount :=
  fold_right (fun m l => PositiveMap.add m (plus w (load_of m l)) l) loads ms.

Fixpoint find_all {A B} (f : A -> option B) (l : list (A * amount)) : option (list (B * amount)) :=
  match l with
  | [] => Some []
  | (k, w) :: l => match f k, find_all f l with
                   | Some x, Some r => Some ((x, w) :: r)
                   | _, _ => None
                   end
  end.

Definition weight_of {A} (x : A * amount) : amount := snd x.
Definition loads_of (without : set) (ws : list (cut * amount)) : PositiveMap.t amount :=
  fold_right (fun x => pour (snd x) (filter (fun m => negb (mem m without)) (members (fst x))))
             (PositiveMap.empty amount) ws.

(** How much an action can carry: its cost, and the weight of each limit for as much as it takes of it. *)
Definition capacity (k : N) (ls : list (row * amount)) (m : id) : amount :=
  plus (times k (cost P m)) (total (fun x => times (takes (fst x) m) (snd x)) ls).

(** What all actions but the used ones cost at least: weights of cuts, less the weights of what is left of limits. *)
Definition lower (used : list id) (ws : list (cut * amount)) (ls : list (row * amount)) (more less : amount) :=
  plus (plus (plus (total weight_of ws) (total (fun x => times (count (takes (fst x)) used) (snd x)) ls)) more)
       (minus (plus (total (fun x => times (most (fst x)) (snd x)) ls) less)).

(** The first part that is to be rounded and is no multiple is rounded up, and what comes after it becomes 0. *)
Fixpoint round (k : N) (g : list (positive * bool)) (a : amount) : amount :=
  match g, a with
  | (z, here) :: g, p :: a =>
      let unit := Z.of_N k * Zpos z in
      if here && negb (number p mod unit =? 0)
      then [Part (unit * (number p / unit + 1)) 1 1]
      else p :: round k g a
  | _, _ => a
  end.

Definition enough (used : list id) (l : leaf) (bound : amount) : bool :=
  leb n (times (scale l) least)
      (plus (round (scale l) (combine (grid P) (rounded l)) bound) (times (scale l) (total (cost P) used))).

(** Check a leaf; [above] are actions for which the bound with their reduced cost has to be enough, if there are any,
    and otherwise the bound itself. *)
Definition check_leaf (used : list id) (without : set) (l : leaf) (above : option (list id)) : bool :=
  match find_all (fun k => PositiveMap.find k cuts) (weights l), find_all (rows P) (limits l) with
  | Some ws, Some ls =>
      let loads := loads_of without ws in
      (0 <? scale l)%N
      && forallb (fun x => required used (fst x) && leb n [] (snd x)) ws
      && forallb (fun x => leb n [] (snd x)) ls
      && forallb (fun x => leb n (snd x) (if among (fst x) used then [] else capacity (scale l) ls (fst x)))
                 (PositiveMap.elements loads)
      && match above with
         | None => enough used l (lower used ws ls [] [])
         | Some ds => forallb (fun d => negb (among d used)
                        && enough used l (lower used ws ls (capacity (scale l) ls d) (load_of d loads))) ds
         end
  | _, _ => false
  end.

Fixpoint check (used : list id) (without : set) (p : proof) : bool :=
  match p with
  | Weighed l => check_leaf used without l None
  | Fixed l above others =>
      check_leaf used without l (Some above) && check used (fold_right insert without above) others
  | Hopeless k =>
      match PositiveMap.find k cuts with
      | Some c => required used c && forallb (fun m => mem m without) (members c)
      | None => false
      end
  | Broken => impossible P
  | Branch m p q =>
      negb (among m used) && check used (insert m without) p && check (m :: used) without q
  end.

(** ** The proof *)

Hypothesis ok : sound P.
Hypothesis cuts_ok : forall k c, PositiveMap.find k cuts = Some c -> exists l, c = cut_of l.

(** Each part is at least that of nothing. *)
Lemma good_nonneg k a : Forall good_part a -> le k [] a.
Proof.
  unfold le. revert a; induction k as [|k IH]; intros a H; cbn; try discriminate.
  destruct a as [|p a]; cbn; [apply IH; constructor|].
  inversion H as [|? ? [G F] R]; subst. unfold compare_part.
  change (number nil_part) with 0. rewrite Pos.mul_1_l, Pos.mul_1_r.
  destruct (Z.compare_spec 0 (number p)); try discriminate; [|lia].
  destruct (Pos.compare_spec (under p) (over p)); try discriminate; [|lia].
  now apply IH.
Qed.

(** Costs are good, by the checks of the problem. *)
Lemma cost_nonneg k m : le k [] (cost P m).
Proof. apply good_nonneg, cost_good, ok. Qed.

(** Landmarks. Nothing of the cut is there at first; the first action that gives something of it cannot need any
    of it. So if a run reaches something of the cut, it has a member of the cut. *)
Lemma crossed l s : forall have x,
  (forall o, In o have -> ~ In o l) -> runs have s -> In x l ->
  In x (ends have s) \/ (exists u, In u s /\ In x (needs P u)) ->
  exists m, In m s /\ In m (members (cut_of l)).
Proof.
  induction s as [|m s IH]; cbn [runs ends]; intros have x Hh Hr Hx Hc.
  - destruct Hc as [H|(u & [] & _)]. now destruct (Hh x).
  - destruct Hr as [Hn Hr].
    assert (A : avoids (of_list l) (needs P m) = true).
    { apply forallb_forall. intros o Ho. destruct (mem o (of_list l)) eqn:E; trivial.
      apply mem_of_list in E. now destruct (Hh o); [apply Hn|]. }
    destruct (existsb (fun o => mem o (of_list l)) (gives P m)) eqn:G.
    + apply existsb_exists in G. destruct G as (o & Go & Gl). apply mem_of_list in Gl.
      exists m. split; [now left|]. cbn [members cut_of].
      assert (F : mem m (of_list (filter (fun m => avoids (of_list l) (needs P m)) (flat_map (makers P) l))) = true).
      { apply mem_of_list, filter_In. split; trivial. apply in_flat_map. exists o. split; trivial. now apply (makers_all P ok). }
      unfold mem in F. destruct (PositiveMap.find m _) as [[]|] eqn:E; try discriminate.
      apply PositiveMap.elements_correct in E. apply in_map_iff. now exists (m, tt).
    + destruct (IH (gives P m ++ have) x) as (m' & Hs & Hm); trivial.
      * intros o Ho Hl. apply in_app_or in Ho. destruct Ho as [Ho|Ho]; [|now apply (Hh o)].
        assert (existsb (fun o => mem o (of_list l)) (gives P m) = true); [|congruence].
        apply existsb_exists. exists o. split; trivial. now apply mem_of_list.
      * destruct Hc as [H|(u & [->|Hu] & Hx')]; [now left| |right; eauto].
        now destruct (Hh x); [apply Hn|].
      * exists m'. split; trivial. now right.
Qed.

(** A solution on a branch: it has the used actions, and none that are left out. *)
Definition fits (used : list id) (without : set) (s : list id) : Prop :=
  incl used s /\ forall m, In m s -> mem m without = false.

(** A goal is there at the end, and what a used action needs is there before it: [crossed] applies. *)
Lemma required_crossed used without s c k :
  solution s -> fits used without s -> PositiveMap.find k cuts = Some c -> required used c = true ->
  exists m, In m s /\ In m (members c).
Proof.
  intros (Hr & Hg & _) [Hu _] Hk H. destruct (cuts_ok _ _ Hk) as (l & ->). unfold required in H.
  apply Bool.orb_true_iff in H. destruct H as [H|H]; apply existsb_exists in H; destruct H as (x & Hx & H).
  - apply mem_of_list in H. apply (crossed l s [] x); auto.
  - apply existsb_exists in H. destruct H as (o & Ho & H). apply mem_of_list in H.
    apply (crossed l s [] o); auto. right. eauto.
Qed.

(** *** Weights *)

(** By the laws of finite maps. *)
Lemma load_add m m' a l : load_of m (PositiveMap.add m' a l) = if Pos.eq_dec m m' then a else load_of m l.
Proof.
  unfold load_of. destruct (Pos.eq_dec m m') as [->|H]; [now rewrite PositiveMap.gss|].
  now rewrite PositiveMap.gso.
Qed.

(** Pouring a weight on some actions lowers no load, and raises those of these actions by the weight. *)
Lemma pour_more w ms l m : le n [] w ->
  le n (load_of m l) (load_of m (pour w ms l)) /\ (In m ms -> le n (plus w (load_of m l)) (load_of m (pour w ms l))).
Proof.
  intros Hw. induction ms as [|m' ms [IH IH']]; cbn [pour fold_right]; [split; [apply le_refl|easy]|].
  fold (pour w ms l). rewrite load_add. destruct (Pos.eq_dec m m') as [->|H].
  - split; intros; rewrite (plus_comm w); [now apply le_more|].
    rewrite (plus_comm w). now apply le_plus_r.
  - split; trivial. intros [->|Hm]; [easy|auto].
Qed.

(** A function that is nowhere smaller, and larger by w at one member, has a sum larger by w. *)
Lemma total_gain (f g : id -> amount) s x w :
  (forall y, le n (f y) (g y)) -> In x s -> le n (plus w (f x)) (g x) -> le n (plus w (total f s)) (total g s).
Proof.
  intros H. induction s as [|y s IH]; cbn; [easy|]. intros [->|Hx] Hw.
  - rewrite plus_assoc. apply le_plus; trivial. now apply total_le.
  - rewrite plus_swap. apply le_plus; auto.
Qed.

(** Each cut has a member in the solution, which carries its weight. *)
Lemma loads_total used without s ws ks :
  solution s -> fits used without s ->
  find_all (fun k => PositiveMap.find k cuts) ks = Some ws ->
  forallb (fun x => required used (fst x) && leb n [] (snd x)) ws = true ->
  le n (total weight_of ws) (total (fun m => load_of m (loads_of without ws)) s).
Proof.
  intros Hs Hf. revert ws; induction ks as [|[k w] ks IH]; intros ws Hk.
  - injection Hk as <-. intros _. cbn. apply total_nonneg. intros. unfold load_of. rewrite PositiveMap.gempty. apply le_refl.
  - cbn in Hk. destruct (PositiveMap.find k cuts) as [c|] eqn:E; try discriminate.
    destruct (find_all _ ks) as [ws'|]; try discriminate. injection Hk as <-.
    cbn [forallb fst snd]. intros H. apply andb_prop in H. destruct H as [H H']. apply andb_prop in H. destruct H as [Hq Hw].
    apply leb_le in Hw. destruct (required_crossed _ _ _ _ _ Hs Hf E Hq) as (m & Hm & Hc).
    cbn [total loads_of fold_right fst snd]. fold (loads_of without ws'). unfold weight_of at 1; cbn [snd].
    eapply le_trans; [apply le_plus_l, IH; trivial|].
    apply (total_gain _ _ s m); trivial.
    + intros y. now apply pour_more.
    + apply pour_more; trivial. apply filter_In. split; trivial. destruct Hf as [_ Hf]. now rewrite Hf.
Qed.

(** All that is found was looked up. *)
Lemma find_all_rows ks : forall ls, find_all (rows P) ks = Some ls -> forall x, In x ls -> exists k, rows P k = Some (fst x).
Proof.
  induction ks as [|[k w] ks IH]; cbn; intros ls H; [injection H as <-; easy|].
  destruct (rows P k) as [r|] eqn:E; try discriminate. destruct (find_all _ ks); try discriminate.
  injection H as <-. intros x [<-|Hx]; eauto.
Qed.

(** By induction on one of the two numbers. *)
Lemma times_sum i j w : compare n (times (i + j) w) (plus (times i w) (times j w)) = Eq.
Proof.
  induction i as [|i IH] using N.peano_ind.
  - rewrite N.add_0_l. change (times j w) with (plus [] (times j w)) at 1. rewrite plus_both, sym, times_0. reflexivity.
  - replace (N.succ i + j)%N with (N.succ (i + j)) by lia.
    rewrite !times_succ, <- plus_assoc, !(plus_comm w), plus_both. exact IH.
Qed.

(** A limit takes as much of a sequence as of its actions together. *)
Lemma times_count (f : id -> N) w l : compare n (total (fun m => times (f m) w) l) (times (count f l) w) = Eq.
Proof.
  induction l as [|m l IH]; cbn [total count].
  - rewrite sym, times_0. reflexivity.
  - rewrite sym, (eq_l _ _ _ _ (times_sum _ _ _)), !(plus_comm (times (f m) w)), plus_both, sym, IH. reflexivity.
Qed.

(** Equal amounts are at most each other. *)
Lemma eq_le a b : compare n a b = Eq -> le n a b /\ le n b a.
Proof. unfold le. intros H. rewrite (sym n a b), H. split; discriminate. Qed.

(** What actions can carry beyond their costs is what they take of limits. *)
Lemma capacity_total k ls s :
  le n (total (capacity k ls) s)
       (plus (times k (total (cost P) s)) (total (fun x => times (count (takes (fst x)) s) (snd x)) ls)).
Proof.
  unfold capacity. rewrite total_plus, total_times. apply le_plus_l.
  induction ls as [|[r w] ls IH]; cbn [total fst snd].
  - rewrite total_nil. apply le_refl.
  - rewrite total_plus. apply le_plus; trivial. exact (proj1 (eq_le _ _ (times_count (takes r) w s))).
Qed.

(** The order of a sum does not matter. *)
Lemma perm_total (f : id -> amount) s t : Permutation s t -> total f s = total f t.
Proof. induction 1; cbn; try congruence. apply plus_swap. Qed.
(** Nor that of a count. *)
Lemma perm_count f s t : Permutation s t -> count f s = count f t.
Proof. induction 1; cbn; lia. Qed.

(** The used actions once each, and the rest of the solution. *)
Lemma split_used (used s : list id) : NoDup used -> incl used s -> exists rest, Permutation s (used ++ rest).
Proof.
  revert s; induction used as [|u used IH]; intros s Hd Hi; [now exists s|].
  inversion Hd; subst. destruct (in_split u s) as (a & b & ->); [apply Hi; now left|].
  destruct (IH (a ++ b)) as (rest & Hp); trivial.
  - intros x Hx. assert (H : In x (a ++ u :: b)) by (apply Hi; now right).
    apply in_app_iff in H. apply in_app_iff. destruct H as [H|[H|H]]; auto. subst. easy.
  - exists rest. cbn. rewrite <- Hp. symmetry. apply Permutation_middle.
Qed.

(** Weights are a lower bound. Each cut weighs on an action of the rest, for the used ones carry nothing; no action
    carries more than its capacity; and what was allowed beyond the costs is no more than the limits leave. *)
Lemma lower_bound used without l ws ls s rest more less :
  solution s -> fits used without s -> Permutation s (used ++ rest) ->
  find_all (fun k => PositiveMap.find k cuts) (weights l) = Some ws -> find_all (rows P) (limits l) = Some ls ->
  forallb (fun x => required used (fst x) && leb n [] (snd x)) ws = true ->
  forallb (fun x => leb n [] (snd x)) ls = true ->
  (forall m, In m used -> le n (load_of m (loads_of without ws)) []) ->
  le n (plus (total (fun m => load_of m (loads_of without ws)) rest) more) (plus (total (capacity (scale l) ls) rest) less) ->
  le n (lower used ws ls more less) (times (scale l) (total (cost P) rest)).
Proof.
  intros Hs Hf Hp Hws Hls Hw Hl Hu Hc. unfold lower. apply le_minus.
  pose proof (loads_total _ _ _ _ _ Hs Hf Hws Hw) as W.
  rewrite (perm_total _ _ _ Hp), total_app in W.
  assert (U : le n (total (fun m => load_of m (loads_of without ws)) used) [])
    by (rewrite <- (total_nil used); now apply total_le).
  apply (le_plus_r n _ _ (total (fun m => load_of m (loads_of without ws)) rest)) in U.
  pose proof (le_trans _ _ _ _ W U) as W'. cbn [plus] in W'. clear W U.
  set (A := total (fun x => times (count (takes (fst x)) used) (snd x)) ls).
  assert (L : le n (plus A (total (fun x => times (count (takes (fst x)) rest) (snd x)) ls))
                   (total (fun x => times (most (fst x)) (snd x)) ls)).
  { unfold A. rewrite <- total_plus. apply total_le. intros x Hx.
    destruct (find_all_rows _ _ Hls x Hx) as (k & Hk). destruct Hs as (_ & _ & _ & Hs). specialize (Hs _ _ Hk).
    rewrite (perm_count _ _ _ Hp), count_app in Hs.
    apply le_trans with (times (count (takes (fst x)) used + count (takes (fst x)) rest)%N (snd x)).
    - exact (proj2 (eq_le _ _ (times_sum _ _ _))).
    - apply times_more; trivial. rewrite forallb_forall in Hl. now apply leb_le, Hl. }
  pose proof (capacity_total (scale l) ls rest) as C.
  set (T := total weight_of ws) in *. set (D := times (scale l) (total (cost P) rest)) in *.
  set (M := total (fun x => times (most (fst x)) (snd x)) ls) in *.
  set (R := total (fun x => times (count (takes (fst x)) rest) (snd x)) ls) in *.
  set (K := total (capacity (scale l) ls) rest) in *.
  set (Q := total (fun m => load_of m (loads_of without ws)) rest) in *.
  (* T + A + more <= A + Q + more <= A + K + less <= A + D + R + less <= D + M + less *)
  rewrite (plus_comm T A), <- plus_assoc.
  apply le_trans with (plus A (plus K less)).
  { apply le_plus_l. eapply le_trans; [|apply Hc]. now apply le_plus_r. }
  apply le_trans with (plus A (plus (plus D R) less)); [now apply le_plus_l, le_plus_r|].
  rewrite !plus_assoc. apply le_plus_r. rewrite (plus_comm A D), <- plus_assoc. now apply le_plus_l.
Qed.

(** *** Rounding *)

(** Numbers from 0 add up, and factors from 1 multiply, to such. *)
Lemma good_plus a : forall b, Forall good_part a -> Forall good_part b -> Forall good_part (plus a b).
Proof.
  induction a as [|p a IH]; intros [|q b] Ha Hb; cbn; trivial.
  inversion Ha as [|? ? [] ?]; inversion Hb as [|? ? [] ?]; subst. constructor; auto.
  unfold good_part; cbn. split; [lia|nia].
Qed.

(** Multiples of a number add up to multiples. *)
Lemma aligned_plus g : forall a b, aligned g a -> aligned g b -> aligned g (plus a b).
Proof.
  induction g as [|z g IH]; intros [|p a] [|q b]; cbn; trivial. intros [] []. split; auto. now apply Z.divide_add_r.
Qed.

(** So what a sequence costs is good and aligned, by induction along it. *)
Lemma cost_total s : Forall good_part (total (cost P) s) /\ aligned (grid P) (total (cost P) s).
Proof.
  induction s as [|m s [IH IH']]; cbn.
  - split; [constructor|]. now destruct (grid P).
  - split; [apply good_plus|apply aligned_plus]; trivial; apply ok.
Qed.

(** A bound on a sum of multiples: if a part of the bound is no multiple, the sum has the next multiple there, and
    no less than nothing after it; or it is above the bound before, and above what is rounded up. *)
Lemma round_le k g : forall m x c marks, (0 < k)%N ->
  Forall good_part c -> aligned g c -> le m x (times k c) -> le m (round k (combine g marks) x) (times k c).
Proof.
  induction g as [|z g IH]; intros m x c marks Hk Hg Ha H; [trivial|].
  destruct marks as [|here marks]; [trivial|]. destruct x as [|p x]; [trivial|].
  destruct m as [|m]; [discriminate|]. cbn [combine round].
  set (q := first c).
  assert (Hq : good_part q) by (unfold q; destruct c; [split; cbn; lia|now inversion Hg]).
  assert (Hz : (Zpos z | number q)) by (unfold q; destruct c; [apply Z.divide_0_r|apply Ha]).
  assert (Hg' : Forall good_part (tl c)) by (destruct c; [trivial|now inversion Hg]).
  assert (Ha' : aligned g (tl c)) by (destruct c; [now destruct g|apply Ha]).
  assert (Et : tl (times k c) = times k (tl c)) by now destruct c.
  assert (Eq' : compare_part (first (times k c)) (times_part k q) = Eq).
  { unfold q; destruct c; cbn [first hd times map]; [|apply part_refl].
    unfold compare_part, times_part; cbn [number over under nil_part]. rewrite Z.mul_0_r. cbn.
    now rewrite power_1. }
  unfold le in *. cbn [compare first hd tl] in *. rewrite Et in *.
  assert (F : forall r, compare_part r (first (times k c)) = compare_part r (times_part k q)).
  { intros r. rewrite part_sym, (part_eq _ _ _ Eq'), <- part_sym. trivial. }
  change (hd nil_part (times k c)) with (first (times k c)) in *. rewrite F in *.
  destruct (here && negb (number p mod (Z.of_N k * Zpos z) =? 0)%Z) eqn:B.
  - apply andb_prop in B. destruct B as [_ Bm]. apply Bool.negb_true_iff, Z.eqb_neq in Bm.
    cbn [first hd tl]. set (unit := (Z.of_N k * Zpos z)%Z) in *.
    assert (Hu : (0 < unit)%Z) by (unfold unit; nia).
    destruct Hz as (t & Hz). assert (Hqu : (Z.of_N k * number q = t * unit)%Z) by (unfold unit; rewrite Hz; ring).
    pose proof (Z.div_mod (number p) unit ltac:(lia)) as Dm. pose proof (Z.mod_pos_bound (number p) unit Hu) as Mb.
    assert (Below : (number p < t * unit)%Z).
    { destruct (compare_part p (times_part k q)) eqn:E; try easy; unfold compare_part in E; cbn [number times_part] in E;
        rewrite Hqu in E; destruct (Z.compare_spec (number p) (t * unit)) as [C| |]; try lia; try discriminate;
        exfalso; apply Bm; rewrite C; apply Z.mod_mul; lia. }
    assert (Up : (unit * (number p / unit + 1) <= t * unit)%Z).
    { rewrite (Z.mul_comm t). apply Z.mul_le_mono_nonneg_l; [lia|].
      assert (number p / unit < t)%Z by (apply Z.div_lt_upper_bound; lia). lia. }
    unfold compare_part; cbn [number times_part over under]. rewrite Hqu.
    destruct (Z.compare_spec (unit * (number p / unit + 1)) (t * unit)); try discriminate; try lia.
    rewrite Pos.mul_1_r, Pos.mul_1_l.
    assert (Hp : (power (under q) k <= power (over q) k)%positive).
    { destruct Hq as [_ Hq]. clear - Hq. induction k as [|k IH] using N.peano_ind; [cbn; lia|]. rewrite !power_succ. nia. }
    destruct (Pos.compare_spec (power (under q) k) (power (over q) k)); try discriminate; try lia.
    apply times_nonneg, good_nonneg; trivial.
  - cbn [first hd tl]. destruct (compare_part p (times_part k q)); try easy. apply IH; trivial.
Qed.

(** What the used actions cost and the bound on the rest are together the cost of the solution; all is divided by the
    scale. *)
Lemma enough_least used without s rest l bound :
  Permutation s (used ++ rest) -> fits used without s -> (0 < scale l)%N ->
  le n bound (times (scale l) (total (cost P) rest)) -> enough used l bound = true -> le n least (total (cost P) s).
Proof.
  intros Hp Hf Hk Hb H. apply leb_le in H. apply (times_cancel n (scale l)); trivial.
  rewrite (perm_total _ _ _ Hp), total_app, times_plus, plus_comm.
  eapply le_trans; [exact H|]. apply le_plus_r. apply round_le; trivial; apply cost_total.
Qed.

(** A leaf holds for all solutions of its branch; where some actions are above the cutoff, for those that have one. *)
Lemma check_leaf_ok used without l above s :
  NoDup used -> solution s -> fits used without s -> check_leaf used without l above = true ->
  match above with None => True | Some ds => exists d, In d ds /\ In d s end ->
  le n least (total (cost P) s).
Proof.
  intros Hd Hs Hf H Ha. unfold check_leaf in H.
  destruct (find_all (fun k => PositiveMap.find k cuts) (weights l)) as [ws|] eqn:Ews; try discriminate.
  destruct (find_all (rows P) (limits l)) as [ls|] eqn:Els; try discriminate.
  apply andb_prop in H. destruct H as [H Habove]. apply andb_prop in H. destruct H as [H Hload].
  apply andb_prop in H. destruct H as [H Hls]. apply andb_prop in H. destruct H as [Hk Hws]. apply N.ltb_lt in Hk.
  destruct (split_used used s Hd (proj1 Hf)) as (rest & Hp).
  assert (Hcap : forall m, le n [] (capacity (scale l) ls m)).
  { intros m. apply le_more; [apply times_nonneg, cost_nonneg|]. apply total_nonneg. intros x Hx.
    apply times_nonneg. rewrite forallb_forall in Hls. now apply leb_le, Hls. }
  assert (L : forall m, le n (load_of m (loads_of without ws)) (if among m used then [] else capacity (scale l) ls m)).
  { intros m. unfold load_of. destruct (PositiveMap.find m (loads_of without ws)) as [a|] eqn:E.
    - apply PositiveMap.elements_correct in E. rewrite forallb_forall in Hload. apply Hload in E. now apply leb_le in E.
    - destruct (among m used); [apply le_refl|apply Hcap]. }
  assert (Lu : forall m, In m used -> le n (load_of m (loads_of without ws)) []).
  { intros m Hm. specialize (L m). rewrite (proj2 (among_in m used) Hm) in L. exact L. }
  assert (Lc : forall m, le n (load_of m (loads_of without ws)) (capacity (scale l) ls m)).
  { intros m. eapply le_trans; [apply L|]. destruct (among m used); [apply Hcap|apply le_refl]. }
  destruct above as [ds|].
  - destruct Ha as (d & Hds & Hd'). rewrite forallb_forall in Habove. apply Habove in Hds.
    apply andb_prop in Hds. destruct Hds as [Hnu He].
    apply (enough_least used without s rest l _ Hp Hf Hk) in He; trivial.
    eapply lower_bound; eauto.
    assert (Hr : In d rest).
    { apply (Permutation_in d Hp) in Hd'. apply in_app_or in Hd'. destruct Hd' as [Hd'|]; trivial.
      apply among_in in Hd'. now rewrite Hd' in Hnu. }
    clear - Hr Lc. induction rest as [|m rest IH]; cbn [total]; [easy|].
    destruct Hr as [->|Hr].
    + rewrite (plus_comm (plus (load_of d _) _)), (plus_comm (load_of d _)), plus_assoc.
      apply le_plus_r, le_plus_l, total_le. intros. apply Lc.
    + rewrite <- !plus_assoc. apply le_plus; auto.
  - apply (enough_least used without s rest l _ Hp Hf Hk) in Habove; trivial.
    eapply lower_bound; eauto. rewrite !plus_nil. apply total_le. intros. apply Lc.
Qed.

(** Actions that a solution does not have can be left out. *)
Lemma fits_without used without s ds :
  fits used without s -> (forall d, In d ds -> ~ In d s) -> fits used (fold_right insert without ds) s.
Proof.
  intros [Hu Hw] H. split; trivial. intros m Hm.
  induction ds as [|d ds IH]; cbn; [auto|].
  destruct (mem m (insert d (fold_right insert without ds))) eqn:E; trivial.
  apply mem_insert in E. destruct E as [->|E]; [exfalso; eapply H; [now left|trivial]|].
  rewrite IH in E; [discriminate|]. intros. apply H. now right.
Qed.

(** The theorem: by cases along the branches. A solution has the action of a branch or not; it has an action above the
    cutoff or none. *)
Theorem check_ok p : forall used without s,
  NoDup used -> solution s -> fits used without s -> check used without p = true -> le n least (total (cost P) s).
Proof.
  induction p as [l|l above others IH|k| |m p IHp q IHq]; intros used without s Hd Hs Hf H; cbn in H.
  - now apply (check_leaf_ok used without l None).
  - apply andb_prop in H. destruct H as [Hl Ho].
    destruct (existsb (fun d => among d s) above) eqn:E.
    + apply existsb_exists in E. destruct E as (d & Ha & E). apply among_in in E.
      eapply check_leaf_ok; eauto. cbn. eauto.
    + apply (IH used (fold_right insert without above)); trivial. apply fits_without; trivial. intros d Ha Hi.
      assert (existsb (fun d => among d s) above = true); [|congruence].
      apply existsb_exists. exists d. split; trivial. now apply among_in.
  - destruct (PositiveMap.find k cuts) as [c|] eqn:E; try discriminate. apply andb_prop in H. destruct H as [Hr Hm].
    destruct (required_crossed _ _ _ _ _ Hs Hf E Hr) as (m & Hi & Hc).
    rewrite forallb_forall in Hm. apply Hm in Hc. destruct Hf as [_ Hf]. now rewrite Hf in Hc.
  - destruct Hs as (_ & _ & Hs & _). congruence.
  - apply andb_prop in H. destruct H as [H Hq]. apply andb_prop in H. destruct H as [Hn Hp].
    destruct (among m s) eqn:E.
    + apply among_in in E. apply (IHq (m :: used) without); trivial.
      * constructor; trivial. intros Hm. apply among_in in Hm. now rewrite Hm in Hn.
      * destruct Hf as [Hu Hw]. split; trivial. intros x [<-|Hx]; auto.
    + apply (IHp used (insert m without)); trivial. apply (fits_without used without s [m]); trivial.
      intros d [<-|[]] Hi. apply among_in in Hi. congruence.
Qed.
End Solutions.
