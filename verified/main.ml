(* Reads data and a certificate as numbers and asks the proved checker.

   On the input stand two JSON values: the data (what the digests of a certificate are computed from) and the certificate.
   The answer is one line: "accepted" (exit code 0), "refused: ..." (1), or "not checked: ..." (3) for what the checker
   does not know. *)

open Json
module C = Checker

exception Unknown of string

let unknown message = raise (Unknown message)

(* Ids are from 0 in files, and from 1 in the checker. *)
let id value = let n = number value in if Z.sign n >= 0 then Z.succ n else refuse "expected an id"

let names : (string, Z.t) Hashtbl.t = Hashtbl.create 1000
let name word = match Hashtbl.find_opt names word with
  | Some n -> n
  | None -> let n = Z.of_int (Hashtbl.length names + 1) in Hashtbl.add names word n; n
let named value = name (text value)

let map_of pairs = List.fold_left (fun m (k, v) -> C.PositiveMap.add k v m) C.PositiveMap.empty pairs
let numbered from l = List.mapi (fun i v -> (Z.of_int (i + from), v)) l
let lcm_of = List.fold_left (fun a q -> Z.lcm a q.Q.den) Z.one
let whole q = if Z.equal q.Q.den Z.one then q.Q.num else failwith "not whole"
let natural value = let n = number value in if Z.sign n < 0 then refuse "expected a number from 0" else n

(* --- the data *)

let node value = match list value with
  | [label; _; relations; contents] ->
    let ingredients = List.concat_map (fun c -> List.map named (list (snd (pair c)))) (list contents) in
    { C.label = named label; ingredients; located = List.map (fun r -> named (snd (pair r))) (list relations) }
  | _ -> refuse "expected an object node"

type data = { foon : C.foon; count_of_nodes : int; coins : Z.t; network_rates : Q.t list; sources : Json.t list }

let read_data value goals implied =
  let nodes, motions, inputs, outputs, below = match list (get "network" value) with
    | _ :: nodes :: motions :: inputs :: outputs :: below -> (list nodes, list motions, list inputs, list outputs, below)
    | _ -> refuse "expected a network" in
  let side l = List.map id (list l) in
  let detail number (ins, outs) = { C.its_number = Z.of_int number; ins = side ins; outs = side outs } in
  let sides = List.combine inputs outputs in
  (* below level 3, each unit and node stands for some of another network *)
  let detailed, merged, details = match below with
    | [] -> (nodes, List.mapi (fun i _ -> i + 1) nodes, List.mapi (fun i s -> [detail (i + 1) s]) sides)
    | [whole; stands_for] ->
      let detailed, ins, outs = match list whole with
        | [Number three; nodes; _; ins; outs] when Z.equal three Z.(~$3) -> (list nodes, list ins, list outs)
        | _ -> refuse "expected a network of level 3" in
      let places = Hashtbl.create 1000 in
      List.iteri (fun i n -> Hashtbl.replace places (canonical n) (i + 1)) nodes;
      let lowest = match get "network" value with List (Number n :: _) -> Z.equal n Z.one | _ -> false in
      let merge n = match list n with
        | [label; states; relations; _] ->
          let kept = if lowest then [label; List []; List []; List []] else [label; states; relations; List []] in
          (match Hashtbl.find_opt places (canonical (List kept)) with
           | Some place -> place
           | None -> refuse "a node has become none")
        | _ -> refuse "expected an object node" in
      let all = Array.of_list (List.combine ins outs) in
      let of_unit n = let i = Z.to_int (number n) in
        if i < 0 || i >= Array.length all then refuse "expected the id of a unit" else detail (i + 1) all.(i) in
      (detailed, List.map merge detailed, List.map (fun l -> List.map of_unit (list l)) (list stands_for))
    | _ -> refuse "expected a network" in
  let unit (motion, (ins, outs)) details =
    { C.motion = named motion; inputs = side ins; outputs = side outs; details } in
  let units = List.map2 unit (List.combine motions sides) details in
  let rates = match get "rates" value with
    | Null -> []
    | known -> List.map (fun r -> let m, q = pair r in (named m, fraction q)) (list known) in
  let possible = List.filter (fun (_, q) -> Q.sign q > 0) rates in
  let by_motion, by_unit = match get "prices" value with
    | Null -> ([], [])
    | known -> let m, u = pair known in
      let read key l = List.map (fun p -> let k, q = pair p in (key k, fraction q)) (list l) in
      (read named m, read id u) in
  if List.exists (fun (_, q) -> Q.sign q < 0) (by_motion @ by_unit) then refuse "a price is below 0";
  (* limits of prices are in hundredths *)
  let coins = Z.mul (Z.of_int 100) (lcm_of (List.map snd (by_motion @ by_unit))) in
  let in_coins = List.map (fun (k, q) -> (k, whole (Q.mul q (Q.of_bigint coins)))) in
  let foon = {
    C.nodes = map_of (numbered 1 (List.map node nodes)); detailed_nodes = map_of (numbered 1 (List.map node detailed));
    merged = map_of (numbered 1 (List.map Z.of_int merged)); units = map_of (numbered 1 units);
    kitchen = C.of_list (side (get "kitchen" value)); wanted = goals; implied;
    utensils = C.of_list (List.map named (list (get "utensils" value)));
    rates = map_of (List.map (fun (m, q) -> (m, (q.Q.num, q.Q.den))) possible);
    motion_prices = map_of (in_coins by_motion); unit_prices = map_of (in_coins by_unit) } in
  let used = List.sort_uniq compare (List.map text motions) in
  let network_rates = List.filter_map (fun m -> List.assoc_opt (name m) rates) used in
  let sources = match get "sources" value with Null -> [] | l -> list l in
  { foon; count_of_nodes = List.length nodes; coins; network_rates; sources }

(* The checker knows rates above 0: a motion without one has no success. *)
let never_zero data =
  if List.exists (fun q -> Q.sign q = 0) data.network_rates then unknown "a motion that never succeeds"

(* --- rules *)

let natural_fraction word =
  let q = fraction (Text word) in
  if Q.sign q > 0 && Z.equal q.Q.den Z.one then q.Q.num else refuse "a limit counts what is no whole number above zero"

(* The rules of a certificate, of those with a limit by their number in it, and how many nodes they add. *)
let read_rules data values =
  let sources = ref data.sources and nodes = ref data.count_of_nodes in
  let asking r = incr nodes; (Z.of_int !nodes, r) in
  let plain r = (Z.zero, r) in
  let read number value =
    let str key = named (get key value) in
    let num key = let n = Json.number (get key value) in if Z.sign n < 0 then unknown "limits below 0" else n in
    let strs key = List.map named (list (get key value)) in
    let limit r = [(Z.of_int (-number - 1), r)] in
    let by_names least = match !sources with
      | of_units :: others ->
        sources := others;
        [plain (C.Least_names (map_of (numbered 1 (List.map (fun l -> Z.of_int (List.length (list l))) (list of_units))), least))]
      | [] -> refuse "the sources that a rule looks at are missing" in
    match text (get "rule" value) with
    | "forbid_motion" -> [plain (C.Forbid_motion (str "forbidden_motion"))]
    | "forbid_object" -> [plain (C.Forbid_object (str "forbidden_object"))]
    | "forbid_ingredient" -> [plain (C.Forbid_ingredient (strs "allergen"))]
    | "least_rate" -> never_zero data; [plain (C.Least_rate (num "least_rate"))]
    | "only_sources" -> by_names Z.one
    | "at_least_videos" -> by_names (num "least_videos")
    | "motion_only_with" -> [plain (C.Motion_only_with (str "tied_motion", str "tied_utensil"))]
    | "never_heated" -> [plain (C.Never_heated (str "unheated_ingredient", strs "heats"))]
    | "require_motion" -> [asking (C.Require_motion (str "required_motion"))]
    | "require_object" -> [asking (C.Require_object (str "required_object"))]
    | "require_ingredient" -> [asking (C.Require_ingredient (str "required_ingredient"))]
    | "at_most_units" -> limit (C.At_most_units (num "max_units"))
    | "at_most_motion" -> limit (C.At_most_motion (str "limited_motion", num "max_uses"))
    | "at_most_utensil_uses" -> limit (C.At_most_utensil_uses (str "limited_utensil", num "max_utensil_uses"))
    | "at_most_price" -> limit (C.At_most_price (Z.div (Z.mul (num "max_price") data.coins) (Z.of_int 100)))
    | "own" ->
      exactly ["rule"; "claims"; "constants"; "files"; "library"; "limits"] value;
      if List.length (List.filter (fun v -> get "rule" v = Text "own") values) > 1 then
        refuse "rules of the user's own stand twice";
      List.iter (fun file ->
          exactly ["name"; "sha256"; "text"] file;
          if get "sha256" file <> Text (Sha256.digest (text (get "text" file))) then
            refuse "a text of rules does not have its digest") (list (get "files" value));
      let ids l = C.of_list (List.map id (list l)) in
      let claim c = match pair c with
        | List [u], List [] -> plain (C.Said_removed (ids (List [u])))
        | List [], one_of -> asking (C.Said_one_of (ids one_of))
        | _ -> unknown "claims about several units of rules of your own" in
      let amounts a =
        let counted = List.concat_map (fun (n, us) -> List.map (fun u -> (id u, n)) (list us)) (pairs a) in
        if List.length (List.sort_uniq Z.compare (List.map fst counted)) < List.length counted then
          refuse "a limit counts a unit twice";
        map_of (List.map (fun (u, n) -> (u, natural_fraction n)) counted) in
      let said i l = let a, n = pair l in
        (Z.of_int (-(List.length values + i) - 1), C.Said_at_most (amounts a, natural n)) in
      let claims = List.map claim (list (get "claims" value)) in
      claims @ List.mapi said (list (get "limits" value))
    | "require_intermediate" | "at_most_utensils" | "not_both_motions" | "before" | "all_steps" as rule -> unknown ("the rule " ^ rule)
    | _ -> refuse "a rule is unknown" in
  let rules = List.concat (List.mapi read values) in
  (* limits are numbered after all nodes *)
  (List.map (fun (k, r) -> ((if Z.sign k < 0 then Z.sub (Z.of_int !nodes) k else if Z.sign k = 0 then Z.of_int (!nodes + 1_000_000) else k), r)) rules, !nodes)

(* --- amounts *)

(* An objective, and by what its figures are multiplied to be whole. *)
let objective data word =
  let fractions () = List.fold_left (fun a q -> if Q.sign q > 0 then Z.lcm a q.Q.num else a) Z.one data.network_rates in
  match word with
  | "units" -> (C.Units, Z.one)
  | "inputs" -> (C.Inputs, Z.one)
  | "inputs+ingredients" -> (C.Inputs_and_ingredients, Z.one)
  | "kitchen" -> (C.Kitchen, Z.one)
  | "price" -> (C.Price, data.coins)
  | "dissimilarity" -> (C.Dissimilarity, Z.one)
  | "attempts" -> let n = fractions () in (C.Attempts n, n)
  | "success" ->
    never_zero data;
    (C.Success, Z.one)
  | _ -> unknown ("the objective " ^ word)

(* A part of a weight: a number, or exponents of rates. *)
type weight = Sum of Q.t | Product of (Q.t * Q.t) list

let read_weight objectives value =
  let parts = list value in
  if List.length parts <> max 1 (List.length objectives) then refuse "expected one part of a weight for each objective";
  if objectives = [] then List.map (fun p -> Sum (fraction p)) parts
  else List.map2 (fun (f, k) part -> match f with
    | C.Success -> Product (List.map (fun (r, e) ->
        let r = fraction (Text r) in
        if Q.sign r <= 0 || Q.geq r Q.one then refuse "expected rates between 0 and 1 in a weight";
        (r, fraction e)) (pairs part))
    | _ -> Sum (Q.mul (Q.of_bigint k) (fraction part))) objectives parts

let denominators weight = List.concat_map (function Sum q -> [q] | Product l -> List.map snd l) weight

let largest = 1_000_000 (* bits of a power of a rate *)

let power base e =
  if Z.gt (Z.mul (Z.of_int (Z.numbits base)) e) (Z.of_int largest) then unknown "products of rates this long"
  else Z.pow base (Z.to_int e)

(* A weight times a number, which makes it whole. *)
let amount scale weight =
  let times q = whole (Q.mul (Q.of_bigint scale) q) in
  List.map (function
    | Sum q -> { C.number = times q; over = Z.one; under = Z.one }
    | Product l ->
      let factor (o, u) (r, e) =
        let e = times e in
        let a, b = if Z.sign e >= 0 then (r.Q.den, r.Q.num) else (r.Q.num, r.Q.den) in
        (Z.mul o (power a (Z.abs e)), Z.mul u (power b (Z.abs e))) in
      let over, under = List.fold_left factor (Z.one, Z.one) l in
      { C.number = Z.zero; over; under }) weight

(* --- proofs *)

type reading = {
  objectives : (C.objective * Z.t) list; words : string list; data : data; factor : Z.t; infeasible : bool;
  row : Z.t -> Z.t; price_rows : Z.t list; count_of_cuts : int; used_cuts : (Z.t, unit) Hashtbl.t }

let member at value = match pairs value with
  | ["unit", n] -> Z.mul Z.(~$2) (id n)
  | ["item", n] when List.mem "kitchen" at.words -> Z.succ (Z.mul Z.(~$2) (id n))
  | ["step", _] -> unknown "a branch on a step"
  | _ -> refuse "expected a unit or an item"

let multiples leaf = match get_opt "multiples" leaf with None -> [] | Some m -> List.map (fun (k, q) -> (k, fraction q)) (pairs m)

let read_cut at n =
  let k = id n in
  if Z.gt k (Z.of_int at.count_of_cuts) then refuse "expected the number of a cut";
  Hashtbl.replace at.used_cuts k ();
  k

let read_leaf at leaf =
  let rows = match get_opt "limits" leaf with None -> [] | Some l -> list l in
  let read key l = List.map (fun row -> let n, weight = pair row in (key n, read_weight at.objectives weight)) l in
  let weights = read (read_cut at) (list (get "weights" leaf)) in
  if not (ascending (List.map (fun (k, _) -> Z.to_int k) weights)) then refuse "expected weights in order, each once";
  (* prices are limited in hundredths there, and in coins here *)
  let adjusted (k, weight) =
    let by = if List.mem k at.price_rows then Q.make (Z.of_int 100) at.data.coins else Q.one in
    let times = function Sum q -> Sum (Q.mul by q) | Product l -> Product (List.map (fun (r, e) -> (r, Q.mul by e)) l) in
    (at.row k, List.map times weight) in
  let limits = List.map adjusted (read number rows) in
  let common = lcm_of (List.concat_map (fun (_, weight) -> denominators weight) (weights @ limits)) in
  if List.mem "success" at.words then (* the checker computes such powers *)
    List.iter (fun q -> ignore (power q.Q.den (Z.mul common at.factor))) at.data.network_rates;
  let amounts = List.map (fun (k, weight) -> (k, amount (Z.mul common at.factor) weight)) in
  let rounded = List.map (fun word -> List.mem_assoc word (multiples leaf)) at.words in
  { C.scale = if at.infeasible then Z.one else common; weights = amounts weights; limits = amounts limits; rounded }

let rec read_proof at decided value =
  let decide ms = if ms = [] || List.exists (fun m -> List.mem m decided) ms || List.length (List.sort_uniq Z.compare ms) < List.length ms
    then refuse "nothing is decided, or something twice" else ms @ decided in
  match List.sort compare (List.map fst (pairs value)) with
  | ["branch"; "using"; "without"] ->
    let m = member at (get "branch" value) in
    let proof key = read_proof at (decide [m]) (get key value) in
    C.Branch (m, proof "without", proof "using")
  | ["hopeless"] -> C.Hopeless (read_cut at (get "hopeless" value))
  | ["broken"] -> C.Broken
  | keys ->
    if List.exists (fun k -> not (List.mem k ["weights"; "limits"; "multiples"; "dear"; "others"])) keys then
      refuse "expected weights, a hopeless cut, a broken rule or a branch";
    let leaf = read_leaf at value in
    match get_opt "dear" value, get_opt "others" value with
    | None, None -> C.Weighed leaf
    | Some dear, Some others ->
      let dear = List.map (member at) (list dear) in
      C.Fixed (leaf, dear, read_proof at (decide dear) others)
    | _ -> refuse "expected a proof for what is without the dear"

(* All multiples that are stated for an objective, in one. *)
let grid_of proof words =
  let found = Hashtbl.create 8 in
  let rec look value =
    List.iter (fun (k, q) ->
        if Q.sign q <= 0 then refuse "a multiple is not above zero";
        let before = Option.value (Hashtbl.find_opt found k) ~default:q in
        (* the least common multiple of fractions *)
        Hashtbl.replace found k (Q.make (Z.lcm before.Q.num q.Q.num) (Z.gcd before.Q.den q.Q.den))) (multiples value);
    List.iter (fun key -> Option.iter look (get_opt key value)) ["without"; "using"; "others"] in
  look proof;
  Hashtbl.iter (fun k _ -> if not (List.mem k words) then refuse "a multiple is stated for another objective") found;
  fun word -> Hashtbl.find_opt found word

(* --- the certificate *)

let costs_of objectives value =
  let figures = list value in
  if List.length figures <> List.length objectives then refuse "expected what the tree costs by each objective";
  List.map2 (fun (f, k) figure ->
      let q = match figure with Number n -> Q.of_bigint n | _ -> fraction figure in
      match f with
      | C.Success when Q.sign q > 0 -> { C.number = Z.zero; over = q.Q.den; under = q.Q.num }
      | C.Success -> refuse "a tree that never succeeds is no better than another"
      | _ ->
        let whole_figure = Q.mul (Q.of_bigint k) q in
        if not (Z.equal whole_figure.Q.den Z.one) then refuse "the tree does not cost what is stated";
        { C.number = whole_figure.Q.num; over = Z.one; under = Z.one }) objectives figures

let keys = ["format"; "version"; "claim"; "goals"; "containers"; "level"; "objective"; "digests"; "rules"; "measures";
            "not_covered"; "tree"; "costs"; "bound"; "cuts"; "proof"; "seal"]

(* Nothing was changed by accident, and the data are those that it is about. *)
let check_digests data certificate =
  let digest value = Sha256.digest (canonical value) in
  let others = List.filter (fun (k, _) -> k <> "seal") (pairs certificate) in
  if get "seal" certificate <> Text (digest (Object others)) then refuse "the seal does not match: something was changed";
  let stated = get "digests" certificate in
  exactly ["network"; "kitchen"; "rates"; "utensils"; "prices"; "sources"] stated;
  List.iter (fun (k, v) ->
      if get k data <> Null || v <> Null then
        if v <> Text (digest (get k data)) then refuse (k ^ ": not the one that the certificate is about")) (pairs stated)

let check data certificate =
  (match get "format" certificate with
   | Text "foon-asp certificate" -> ()
   | Text "foon-asp certificate of a plan" -> unknown "plans, in which items are used up"
   | _ -> refuse "expected the format 'foon-asp certificate'");
  if not (Z.equal (number (get "version" certificate)) (Z.of_int 5)) then refuse "expected version 5 of the format";
  exactly keys certificate;
  if List.mem_assoc "stand-ins" (pairs data) then unknown "stand-ins";
  check_digests data certificate;
  if not (ascending (List.map text (list (get "not_covered" certificate)))) then refuse "expected names in order";
  if pairs (get "measures" certificate) <> [] then unknown "measures of your own";
  let goals = List.map (fun g -> exactly ["id"; "node"] g; id (get "id" g)) (list (get "goals" certificate)) in
  if goals = [] || List.length (List.sort_uniq Z.compare goals) < List.length goals then
    refuse "expected goals, each of them once";
  let implied = match text (get "containers" certificate) with
    | "implied" -> true | "strict" -> false | _ -> refuse "expected the containers strict or implied" in
  (match list (get "network" data) with
   | level :: _ when level = get "level" certificate -> ()
   | _ -> refuse "not a claim about the level of the network");
  let data = read_data data goals implied in
  let words = List.map text (list (get "objective" certificate)) in
  if List.length (List.sort_uniq compare words) < List.length words then refuse "an objective stands twice";
  let objectives = List.map (objective data) words in
  let rule_values = list (get "rules" certificate) in
  if not (ascending (List.map canonical rule_values)) then refuse "expected rules in order, each of them once";
  let rules, nodes = read_rules data rule_values in
  let cuts = List.map (fun c -> List.map id (list c)) (list (get "cuts" certificate)) in
  if List.exists (fun c -> c = [] || not (List.for_all2 Z.lt (List.rev (List.tl (List.rev c))) (List.tl c))) cuts then refuse "expected ids in order";
  List.iter (List.iter (fun o -> if Z.gt o (Z.of_int nodes) then refuse "expected ids of the network")) cuts;
  let stated = get "proof" certificate and claim = text (get "claim" certificate) in
  let multiple = grid_of stated words in
  let bound = match get "bound" certificate with Null -> None | b -> Some (read_weight objectives b) in
  let factor = match bound with Some b -> lcm_of (denominators b) | None -> Z.one in
  let grid = List.map2 (fun word (_, k) -> match multiple word with
      | None -> Z.one
      | Some q ->
        let q = Q.mul q (Q.of_bigint (Z.mul k factor)) in
        if Z.equal q.Q.den Z.one then q.Q.num else refuse "a cost is not a multiple of what is stated") words objectives in
  let price_rows = List.concat (List.mapi (fun i r -> if get "rule" r = Text "at_most_price" then [Z.of_int i] else []) rule_values) in
  let at = { objectives; words; data; factor; infeasible = claim = "infeasible"; price_rows; used_cuts = Hashtbl.create 100;
             row = (fun k -> Z.add (Z.of_int (nodes + 1)) k); count_of_cuts = List.length cuts } in
  let proof = read_proof at [] stated in
  if Hashtbl.length at.used_cuts < List.length cuts then refuse "a cut is not used by the proof";
  let cuts = map_of (numbered 1 cuts) and fs = List.map fst objectives in
  let tree = match get "tree" certificate with Null -> None | us -> Some (List.map id (list us)) in
  if (tree = None) <> (get "costs" certificate = Null) || (tree <> None && objectives = []) then
    refuse "expected a tree and what it costs, or neither";
  let tree_right () = match tree with
    | None -> true
    | Some us ->
      if List.length (List.sort_uniq Z.compare us) <> List.length us then refuse "an id stands twice";
      C.accept_tree data.foon fs rules us (costs_of objectives (get "costs" certificate)) in
  let require holds otherwise = if not holds then refuse otherwise in
  match claim, tree, bound with
  | "optimal", Some us, None ->
    let costs = costs_of objectives (get "costs" certificate) in
    require (tree_right ()) "the tree does not execute, make the goals, keep to the rules and cost what is stated";
    require (C.accept_optimal data.foon fs rules grid cuts proof us costs) "the proof does not hold"
  | "bound", _, Some b when objectives <> [] ->
    require (tree_right ()) "the tree does not execute, make the goals, keep to the rules and cost what is stated";
    require (C.accept_bound data.foon fs rules factor grid cuts proof (amount factor b)) "the proof does not hold"
  | "infeasible", None, None when objectives = [] ->
    require (C.accept_infeasible data.foon rules cuts proof) "the proof does not hold"
  | _ -> refuse "expected the claim optimal, bound or infeasible, with what belongs to it"

let input_all () =
  let buffer = Buffer.create 1_000_000 and chunk = Bytes.create 65536 in
  let rec fill () =
    let count = input stdin chunk 0 (Bytes.length chunk) in
    if count > 0 then (Buffer.add_subbytes buffer chunk 0 count; fill ()) in
  fill ();
  Buffer.contents buffer

let () =
  let answer, code =
    try
      let input = input_all () in
      let data, after = read input 0 in
      let certificate, ends = read input after in
      if ends <> String.length input then refuse "expected data and a certificate, and nothing after them";
      check data certificate;
      ("accepted", 0)
    with
    | Refused message -> ("refused: " ^ message, 1)
    | Unknown message -> ("not checked: the proved checker does not know " ^ message, 3)
    | Invalid_argument _ | Failure _ -> ("refused: its lists or numbers do not belong together", 1)
    | Stack_overflow | Z.Overflow | Out_of_memory -> ("not checked: it is too large for the proved checker", 3) in
  print_endline answer;
  exit code
